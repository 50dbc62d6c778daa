#include "verify/support/bench_integrators.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

namespace drape::verify {

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

BenchIntegrators::BenchIntegrators() { std::filesystem::create_directory(folder()); }

Command BenchIntegrators::command(const Words& arguments) const {
  return {.program = DRAPE_BENCH_INTEGRATORS,
          .arguments = arguments,
          .folder = folder(),
          .environment = {"DRAPE_CACHE=" + cache().string()},
          .output = {}};
}

std::string BenchIntegrators::output(const Words& arguments) const {
  const ProgramResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string& line : lines(result.err))  // on a slow machine it says how far its reference is
    EXPECT_TRUE(line.starts_with("reference of ") || line.starts_with("note: ") || line.ends_with("; its error follows"))
        << line;
  return result.out;
}

std::map<std::string, std::string> BenchIntegrators::files() const {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder())) {
    const std::string name = entry.path().lexically_relative(folder());
    if (std::filesystem::is_directory(entry.symlink_status())) {
      all[name + '/'];
      continue;
    }
    std::string& content = all[name];
    if (!std::filesystem::is_regular_file(entry.symlink_status())) continue;  // a pipe or a link to a device
    std::ifstream file(entry.path(), std::ios::binary);
    content.assign(std::istreambuf_iterator<char>(file), {});
  }
  return all;
}

void BenchIntegrators::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder() / name) << content;
}

std::string joined(const Words& words, const char* separator) { return fmt::format("{}", fmt::join(words, separator)); }

Words split(const std::string& text, char separator) {
  Words parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

Words lines(const std::string& text) { return split(text, '\n'); }

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

std::vector<Row> parse_csv(const std::string& text) {
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
