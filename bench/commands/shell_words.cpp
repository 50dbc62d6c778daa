#include "bench/commands/shell_words.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace drape::bench {

std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("-_./,:=+@%").find(char(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words;
  bool quoted = false, between = true;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == ' ' && !quoted) {
      between = true;
      continue;
    }
    if (between) words.emplace_back();
    between = false;
    if (line[k] == '\'')
      quoted = !quoted;
    else if (line[k] == '\\' && !quoted && k + 1 < line.size())
      words.back() += line[++k];
    else
      words.back() += line[k];
  }
  return words;
}

}  // namespace drape::bench
