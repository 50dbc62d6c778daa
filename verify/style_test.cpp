// Public texts keep the rules of verify/style.md as far as a program sees it: headers, sources' strings and comments, pages,
// help.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drape::verify::style_test {
namespace {

namespace fs = std::filesystem;

/// Words in lower case, and what to write instead. A word begins and ends where no letter is beside it.
struct Pattern {
  std::string_view words, instead;
};
constexpr Pattern patterns[] = {{"so many", "the quantity"},
                                {"so much", "the quantity"},
                                {"so near", "the distance"},
                                {"is no file", "is not a file"},
                                {"is no number", "is not a number"},
                                {"are no number", "are not numbers"},
                                {"likewise", "in the same way"},
                                {"anew", "again"},
                                {"thrice", "three times"},
                                {"lest", "so that not"},
                                {"be they", "whether they are"},
                                {"people", "users"},
                                {"whoever", "the user who"},
                                {"nobody", "who does not"},
                                {"somebody", "who does"},
                                {"everybody", "all users"},
                                {"begin of", "beginning of"},
                                {"but for", "except"},
                                {", too", "also"}};

/// American spellings.
constexpr Pattern spellings[] = {{"behavior", "behaviour"},
                                 {"color of", "colour of"},
                                 {"neighbor", "neighbour"},
                                 {"factorization", "factorisation"},
                                 {"discretization", "discretisation"}};

bool is_letter(const std::string& text, std::size_t place) {
  return place < text.size() && std::isalpha(static_cast<unsigned char>(text[place])) != 0;
}

/// Whether the words stand in the text and end after its first `before` characters.
bool has_words(const std::string& text, std::string_view words, std::size_t before) {
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
    const bool begins = !std::isalpha(static_cast<unsigned char>(words.front())) || at == 0 || !is_letter(text, at - 1);
    const std::size_t end = at + words.size();
    if (begins && !is_letter(text, end) && end > before) return true;
  }
  return false;
}

/// How the text of a file tells prose from code.
enum class Language { prose, slashes, hashes };

Language language_of(const fs::path& path) {
  const std::string extension = path.extension();
  if (path.filename() == "CMakeLists.txt") return Language::hashes;
  if (extension == ".md" || extension == ".txt") return Language::prose;
  return extension == ".hpp" || extension == ".cpp" || extension == ".js" ? Language::slashes : Language::hashes;
}

/// The prose of a line in lower case: its comment, else its strings.
struct Prose {
  std::string text;
  bool comment = false;
  bool whole_line = false;  ///< nothing else is in the line
};

Prose prose_of(std::string line, Language language) {
  std::ranges::transform(line, line.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (language == Language::prose) return {line, true, true};
  const std::string_view mark = language == Language::slashes ? "//" : "#";
  if (const std::size_t at = line.find(mark); at != std::string::npos)
    return {line.substr(std::min(line.size(), line.find_first_not_of("/#*<! ", at))), true, line.find_first_not_of(' ') == at};
  const std::size_t first = line.find('"');
  return {first == std::string::npos ? "" : line.substr(first), false};
}

/// Finds faults line by line, in phrases that a line break divides too.
class Reader {
 public:
  Reader(std::string name, Language language) : name_(std::move(name)), language_(language) {}

  void read(const std::string& line) {
    ++number_;
    const Prose prose = prose_of(line, language_);
    const bool continued = prose.comment && before_.comment && !before_.text.empty();
    const std::string text = continued ? before_.text + " " + prose.text : prose.text;
    const std::size_t before = continued ? before_.text.size() : 0;
    const auto find_all = [&](const auto& list) {
      for (const auto& [words, instead] : list)
        if (has_words(text, words, before)) add(words, instead);
    };
    find_all(patterns);
    find_all(spellings);
    if (language_ != Language::prose && prose.whole_line && !continued && prose.text.starts_with("of "))
      add("Of …", "a noun or a verb first");
    before_ = prose;
  }

  const std::vector<std::string>& faults() const { return faults_; }

 private:
  void add(std::string_view words, std::string_view instead) {
    faults_.push_back(fmt::format("{}:{}: '{}': write {}", name_, number_, words, instead));
  }

  std::string name_;
  Language language_;
  Prose before_;
  int number_ = 0;
  std::vector<std::string> faults_;
};

std::vector<std::string> faults(const std::string& name, std::initializer_list<std::string> lines) {
  Reader reader(name, language_of(name));
  for (const std::string& line : lines) reader.read(line);
  return reader.faults();
}

std::vector<std::string> faults_of(const fs::path& path, const fs::path& root) {
  Reader reader(path.lexically_relative(root).string(), language_of(path));
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) reader.read(line);
  return reader.faults();
}

bool has_prose(const fs::path& path) {
  const std::string extension = path.extension();
  constexpr std::string_view known[] = {".hpp", ".cpp", ".js", ".md", ".txt", ".py", ".toml", ""};
  return std::ranges::find(known, extension) != std::end(known) && path.filename() != "style.md" &&
         path.filename() != "style_test.cpp";
}

TEST(Style, OfPublicTextsIsPlain) {
  const fs::path root = DRAPE_SOURCE_DIR;
  int files = 0;
  std::vector<std::string> all;
  const auto read = [&](const fs::path& path) {
    ++files;
    std::ranges::copy(faults_of(path, root), std::back_inserter(all));
  };
  for (const char* file : {"README.md", "CMakeLists.txt", ".ci/run", ".ci/prepare.sh"}) read(root / file);
  for (const char* folder : {"solver", "model", "reference", "results", "bench", "verify"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && has_prose(entry.path())) read(entry.path());
  EXPECT_TRUE(all.empty()) << fmt::format("{}", fmt::join(all, "\n"));
  EXPECT_GT(files, 500);
}

TEST(StyleCheck, FindsEachPattern) {
  for (const auto& [words, instead] : patterns)
    EXPECT_EQ(faults("a.hpp", {fmt::format("/// Before {} after.", words)}).size(), 1U) << words;
  for (const auto& [words, instead] : spellings)
    EXPECT_EQ(faults("a.md", {fmt::format("A {} here", words)}).size(), 1U) << words;
  EXPECT_THAT(faults("a.cpp", {"", "throw Error(\"so many bytes\");"}),
              testing::ElementsAre("a.cpp:2: 'so many': write the quantity"));
  EXPECT_THAT(faults("a.js", {"// Not so", "// many of them."}), testing::ElementsAre("a.js:2: 'so many': write the quantity"));
  EXPECT_THAT(faults("CMakeLists.txt", {"# Made anew."}), testing::SizeIs(1));
  EXPECT_THAT(faults("a.hpp", {"/// Of all files."}), testing::SizeIs(1));
}

TEST(StyleCheck, LeavesCodeAndOtherWordsAlone) {
  EXPECT_THAT(faults("a.cpp", {"people(likewise, color);"}), testing::IsEmpty());
  EXPECT_THAT(faults("a.hpp", {"/// The latest of the closest, tooled.", "/// A part", "/// of it.", "int a;  ///< of it"}),
              testing::IsEmpty());
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
