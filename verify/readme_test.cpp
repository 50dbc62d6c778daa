// The pages: the README is short, recorded tables are as recorded, and links, files and command lines are what they seem.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "bench/commands/commands.hpp"
#include "bench/runs/run_spec.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/bench_integrators.hpp"

namespace drape::verify::readme_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

const fs::path root = DRAPE_SOURCE_DIR;

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// All README.md of the sources.
std::vector<fs::path> pages() {
  std::vector<fs::path> all{root / "README.md"};
  for (const char* folder : {"solver", "model", "reference", "results", "bench", "verify"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().filename() == "README.md") all.push_back(entry.path());
  return all;
}

/// What the first group of a pattern matches, everywhere in a text.
Words found(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  Words all;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) all.push_back((*match)[1]);
  return all;
}

/// A text without what is on lines that are code: four spaces before them, or between fences.
std::string without_code_lines(const std::string& text) {
  std::string prose;
  bool fenced = false;
  for (const std::string& line : lines(text)) {
    if (line.starts_with("```")) fenced = !fenced;
    if (!fenced && !line.starts_with("```") && !line.starts_with("    ")) prose += line + "\n";
  }
  return prose;
}

/// The texts between backticks, a line break in them as a space.
Words code_spans(const std::string& page) {
  Words spans = found(without_code_lines(page), "`([^`]+)`");
  for (std::string& span : spans) std::ranges::replace(span, '\n', ' ');
  return spans;
}

TEST(Pages, TheFirstIsShort) { EXPECT_LE(lines(contents(root / "README.md")).size(), 150u); }

TEST(Pages, HaveTheTablesThatAreRecorded) {
  const ProgramResult result = run_program({root / "results/tables", {"--check"}, root, {}, {}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(Pages, LinkToWhatIsThere) {
  for (const fs::path& page : pages())
    for (const std::string& target : found(without_code_lines(contents(page)), R"(\]\(([^)]+)\))")) {
      if (target.starts_with("https://")) continue;
      const std::size_t hash = target.find('#');
      const fs::path file = hash == 0 ? page : page.parent_path() / target.substr(0, hash);
      EXPECT_TRUE(fs::exists(file)) << page << ": " << target;
      if (hash == std::string::npos || !fs::is_regular_file(file)) continue;
      Words anchors;
      for (std::string title : found("\n" + contents(file), "\n#+ ([^\n]+)")) {
        std::erase_if(title, [](char c) { return std::string_view(",.:?()").find(c) != std::string_view::npos; });
        std::ranges::transform(title, title.begin(), [](unsigned char c) { return c == ' ' ? '-' : std::tolower(c); });
        anchors.push_back(title);
      }
      EXPECT_THAT(anchors, testing::Contains(target.substr(hash + 1))) << page << ": " << target;
    }
}

/// Whether a word between backticks names a file or folder of the sources.
bool names_a_source(const std::string& word) {
  static const std::regex inside("(solver|model|reference|results|bench|verify|\\.ci)/[A-Za-z0-9_./-]*");
  static const std::regex source(R"([A-Za-z0-9_./-]+\.(cpp|hpp|js|css|py|patch|cmake|md))");
  return !word.starts_with("results/runs") && (std::regex_match(word, inside) || std::regex_match(word, source));
}

TEST(Pages, NameFilesThatAreThere) {
  for (const fs::path& page : pages()) {
    for (const std::string& span : code_spans(contents(page))) {
      const std::string word = span.substr(0, span.find(' '));
      if (names_a_source(word)) {
        EXPECT_TRUE(fs::exists(root / word) || fs::exists(page.parent_path() / word)) << page << ": " << word;
      }
    }
  }
}

// --- Command lines
// ---------------------------------------------------------------------------------------------------------------

/// What follows bench/run: on lines of code, up to a comment, and between backticks.
Words command_lines(const std::string& page) {
  Words commands = found("\n" + page, "\n    bench/run( [^\n]*)?(?=\n)");
  for (std::string& command : commands) command = command.substr(0, command.find(" #"));
  for (const std::string& span : code_spans(page))
    if (const std::size_t place = span.find("bench/run"); place != std::string::npos) {
      const std::string command = span.substr(place + std::string("bench/run").size());
      if (command.starts_with(' ')) commands.push_back(command);
    }
  return commands;
}

/// A name that stands for others: METHOD, FILE.toml.
bool stands_for_others(const std::string& name) {
  return !name.empty() && std::ranges::none_of(name.substr(0, name.find('.')), [](char c) { return c >= 'a' && c <= 'z'; });
}

Words values_of(const CLI::App& command, const std::string& option) {
  const CLI::Option* found = command.get_option_no_throw(option);
  return found == nullptr || found->empty() ? Words() : found->as<Words>();
}

void expect_method(const std::string& name) {
  if (name == "all" || name == "auto" || stands_for_others(name)) return;
  bench::RunSpec spec{{}, "", nullptr, 1, {}};
  EXPECT_NO_THROW(bench::choose_method(spec, name)) << name;
}

/// That the names on a command line are known.
void expect_names(const CLI::App& command) {
  const Words names = values_of(command, "NAME");
  if (command.get_name() == "study") {
    for (const std::string& name : names) EXPECT_NO_THROW(bench::study(name)) << name;
  }
  for (const std::string& name : values_of(command, "--method")) expect_method(name);
  for (const std::string& name : values_of(command, "--scene")) {
    const bool is_file = name.find('.') != std::string::npos;
    if (!is_file && !stands_for_others(name)) {
      EXPECT_NO_THROW(model::load_scene(name)) << name;
    }
  }
}

/// Parses as the program does, and does nothing.
void expect_parses(const std::string& arguments) {
  CLI::App app;
  app.require_subcommand(0, 1);
  app.set_version_flag("--version", "");
  bool dry_run = false;
  bench::add_main_job(app, dry_run);
  int exit_code = 0;
  bench::add_commands(app, {}, exit_code);
  app.parse_complete_callback([&app] {  // before the commands' own, which do not run
    for (const CLI::App* command : app.get_subcommands()) expect_names(*command);
    throw CLI::Success();
  });
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    EXPECT_EQ(error.get_exit_code(), 0) << error.what();  // 0: parsed, or --help
  }
}

TEST(Pages, HaveCommandLinesThatParse) {
  std::size_t count = 0;
  for (const fs::path& page : pages())
    for (const std::string& command : command_lines(contents(page))) {
      SCOPED_TRACE(fmt::format("{}: bench/run{}", page.string(), command));
      expect_parses(command);
      ++count;
    }
  EXPECT_GE(count, 40u);
}

TEST(Pages, HaveCommandLinesThatAreFound) {
  const std::string page =
      "Text `bench/run study orders\n--quick` and `bench/run`.\n\n    bench/run list  # names\n    bench/run\n    other\n";
  EXPECT_THAT(command_lines(page), testing::ElementsAre(" list ", "", " study orders --quick"));
}

}  // namespace
}  // namespace drape::verify::readme_test
