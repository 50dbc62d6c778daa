#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "verify/run_program.hpp"
#include "verify/temporary_folder.hpp"

namespace drape::verify {

using Words = std::vector<std::string>;

inline Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The program bench_integrators in a new and empty folder, with a cache of references of its own.
class BenchIntegrators {
 public:
  BenchIntegrators() { std::filesystem::create_directory(folder()); }

  std::filesystem::path folder() const { return temporary_ / "work"; }
  std::filesystem::path cache() const { return temporary_ / "cache"; }

  Command command(const Words& arguments) const {
    return {.program = DRAPE_BENCH_INTEGRATORS,
            .arguments = arguments,
            .folder = folder(),
            .environment = {"DRAPE_CACHE=" + cache().string()},
            .output = {}};
  }

  ProgramResult run(const Words& arguments) const { return run_program(command(arguments)); }

  /// What it prints; expects it to succeed without a word on standard error.
  std::string output(const Words& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    return result.out;
  }

  void write(const std::string& name, const std::string& content) const { std::ofstream(folder() / name) << content; }

  /// All that is in the folder and its folders: contents of files by their path; a folder's path ends in '/'.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder())) {
      const std::string name = entry.path().lexically_relative(folder());
      std::ifstream file(entry.path(), std::ios::binary);
      if (entry.is_directory())
        all[name + '/'];
      else
        all[name].assign(std::istreambuf_iterator<char>(file), {});
    }
    return all;
  }

 private:
  TemporaryFolder temporary_;
};

inline std::string joined(const Words& words, const char* separator) { return fmt::format("{}", fmt::join(words, separator)); }

inline Words split(const std::string& text, char separator) {
  Words parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

inline Words lines(const std::string& text) { return split(text, '\n'); }

/// A line of CSV by the names of its columns.
using Row = std::map<std::string, std::string>;

inline double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

/// CSV without quotes.
inline std::vector<Row> parse_csv(const std::string& text) {
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("\"")));
  std::vector<Row> rows;
  Words names;
  for (const std::string& line : lines(text)) {
    const Words cells = split(line + ",", ',');
    if (names.empty()) {
      names = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), names.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < std::min(cells.size(), names.size()); ++k) row[names[k]] = cells[k];
  }
  return rows;
}

}  // namespace drape::verify
