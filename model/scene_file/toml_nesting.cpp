#include "model/scene_file/toml_nesting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "model/keys/scene_error.hpp"

namespace drape::model {
namespace {

/// Where the string that begins at `begin` ends: behind its closing quotes, or at the end of what cannot be a string.
std::size_t end_of_string(std::string_view toml, std::size_t begin) {
  const char quote = toml[begin];
  const bool escapes = quote == '"', long_form = toml.substr(begin, 3) == (escapes ? R"(""")" : "'''");
  const std::size_t quotes = long_form ? 3 : 1;
  for (std::size_t k = begin + quotes; k < toml.size(); ++k) {
    if (escapes && toml[k] == '\\') {
      ++k;
    } else if (!long_form && toml[k] == '\n') {
      return k;
    } else if (std::ranges::all_of(toml.substr(k, quotes), [=](char c) { return c == quote; }) && k + quotes <= toml.size()) {
      std::size_t end = k + quotes;
      for (int more = 0; long_form && more < 2 && end < toml.size() && toml[end] == quote; ++more)
        ++end;  // the text's last ones
      return end;
    }
  }
  return toml.size();
}

}  // namespace

int line_nested_deeper(std::string_view toml, int most) {
  int line = 1, depth = 0, dots = 0;
  for (std::size_t k = 0; k < toml.size();) {
    std::size_t next = k + 1;
    switch (toml[k]) {
      case '#': next = std::min(toml.find('\n', k), toml.size()); break;
      case '"':
      case '\'': next = end_of_string(toml, k); break;
      case '[':
      case '{': ++depth, dots = 0; break;
      case ']':
      case '}': depth = std::max(depth - 1, 0); break;
      case '.': ++dots; break;
      case ',':
      case '=':
      case '\n': dots = 0; break;
      default: break;
    }
    if (depth > most || dots >= most) return line;
    line += static_cast<int>(std::ranges::count(toml.substr(k, next - k), '\n'));
    k = next;
  }
  return 0;
}

toml::table parse_toml(std::string_view text, std::string_view origin, std::string_view nested_deeper) {
  if (const int line = line_nested_deeper(text, most_toml_levels))
    throw SceneError(fmt::format("{}:{}: {}", origin, line, nested_deeper));
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw SceneError(fmt::format("{}:{}: {}", origin, error.source().begin.line, error.description()));
  }
}

}  // namespace drape::model
