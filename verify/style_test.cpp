// Public texts keep the rules of verify/style.md as far as a program sees it: headers, sources' strings and comments, pages,
// help.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace drape::verify::style_test {
namespace {

namespace fs = std::filesystem;

/// Words in lower case, and what to write instead. A word begins and ends where no letter is beside it.
struct Pattern {
  std::string_view words, instead;
};
constexpr Pattern patterns[] = {{"so many", "the quantity"},
                                {"is no file", "is not a file"},
                                {"is no number", "is not a number"},
                                {"are no number", "are not numbers"},
                                {"likewise", "in the same way"},
                                {"lest", "so that not"},
                                {"be they", "whether they are"},
                                {"people", "users"},
                                {"nobody", "who does not"},
                                {"begin of", "beginning of"},
                                {"but for", "except"},
                                {"so near", "the distance"},
                                {", too", "also"}};

/// Spellings of the other side of the ocean.
constexpr Pattern spellings[] = {{"behavior", "behaviour"},
                                 {"color of", "colour of"},
                                 {"neighbor", "neighbour"},
                                 {"factorization", "factorisation"},
                                 {"discretization", "discretisation"}};

bool is_letter(const std::string& text, std::size_t place) {
  return place < text.size() && std::isalpha(static_cast<unsigned char>(text[place])) != 0;
}

bool has_words(const std::string& line, std::string_view words) {
  for (std::size_t at = line.find(words); at != std::string::npos; at = line.find(words, at + 1)) {
    const bool begins = !std::isalpha(static_cast<unsigned char>(words.front())) || at == 0 || !is_letter(line, at - 1);
    if (begins && !is_letter(line, at + words.size())) return true;
  }
  return false;
}

/// What of a line is prose: of a page or a help text all of it, of a source its comments and texts.
std::string prose_of(std::string line, bool source) {
  std::ranges::transform(line, line.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!source) return line;
  if (const std::size_t comment = line.find("//"); comment != std::string::npos) return line.substr(comment);
  const std::size_t first = line.find('"');
  return first == std::string::npos ? "" : line.substr(first);
}

std::vector<std::string> faults(const std::string& name, const std::string& line, int number, bool source) {
  std::vector<std::string> found;
  const std::string prose = prose_of(line, source);
  const auto look = [&](const auto& list) {
    for (const auto& [words, instead] : list)
      if (has_words(prose, words)) found.push_back(fmt::format("{}:{}: '{}': write {}", name, number, words, instead));
  };
  look(patterns);
  look(spellings);
  return found;
}

std::vector<std::string> faults_of(const fs::path& path, const fs::path& root) {
  const std::string extension = path.extension();
  const bool source = extension == ".hpp" || extension == ".cpp";
  std::ifstream file(path);
  std::vector<std::string> all;
  int number = 0;
  for (std::string line; std::getline(file, line);)
    std::ranges::copy(faults(path.lexically_relative(root).string(), line, ++number, source), std::back_inserter(all));
  return all;
}

TEST(Style, OfPublicTextsIsPlain) {
  const fs::path root = DRAPE_SOURCE_DIR;
  int files = 0;
  std::vector<std::string> all = faults_of(root / "README.md", root);
  for (const char* folder : {"solver", "model", "reference", "results", "bench"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp" && extension != ".md" && extension != ".txt") continue;
      ++files;
      std::ranges::copy(faults_of(entry.path(), root), std::back_inserter(all));
    }
  EXPECT_THAT(all, testing::IsEmpty());
  EXPECT_GT(files, 200);
}

TEST(StyleCheck, FindsEachPattern) {
  for (const auto& [words, instead] : patterns)
    EXPECT_EQ(faults("a.hpp", fmt::format("/// Before {} after.", words), 3, true).size(), 1U) << words;
  for (const auto& [words, instead] : spellings)
    EXPECT_EQ(faults("a.md", fmt::format("A {} here", words), 1, false).size(), 1U) << words;
  EXPECT_THAT(faults("a.cpp", "throw Error(\"so many bytes\");", 7, true),
              testing::ElementsAre("a.cpp:7: 'so many': write the quantity"));
}

TEST(StyleCheck, LeavesCodeAndOtherWordsAlone) {
  EXPECT_THAT(faults("a.cpp", "people(likewise, color);", 1, true), testing::IsEmpty());
  EXPECT_THAT(faults("a.hpp", "/// The latest of the closest, tooled.", 1, true), testing::IsEmpty());
}

TEST(StylePage, HasTenRulesAndAGlossaryInSixtyLines) {
  std::ifstream page(fs::path(DRAPE_SOURCE_DIR) / "verify/style.md");
  int lines = 0, rules = 0, words = 0;
  for (std::string line; std::getline(page, line); ++lines) {
    rules += !line.empty() && std::isdigit(static_cast<unsigned char>(line[0])) != 0 ? 1 : 0;
    words += line.starts_with("| ") ? 1 : 0;
  }
  EXPECT_LE(lines, 60);
  EXPECT_EQ(rules, 10);
  EXPECT_GE(words, 15);
}

}  // namespace
}  // namespace drape::verify::style_test
