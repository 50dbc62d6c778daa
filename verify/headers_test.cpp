// Each header includes what it uses: unity builds hide what it does not.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "verify/support/run_program.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::headers_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using Read = std::function<std::string(const std::string& header)>;

/// Headers of the standard library, and what is used of them.
const std::map<std::string, std::vector<std::string>> standard_headers = {
    {"algorithm", {"clamp", "max", "min", "sort"}},
    {"array", {"array"}},
    {"atomic", {"atomic"}},
    {"chrono", {"chrono"}},
    {"cmath", {"abs", "hypot", "isfinite", "isnan", "nan", "pow", "sqrt"}},
    {"complex", {"complex"}},
    {"cstddef", {"byte"}},
    {"cstdint", {"int32_t", "int64_t", "uint8_t", "uint64_t", "uintmax_t"}},
    {"exception", {"current_exception", "exception_ptr"}},
    {"filesystem", {"filesystem"}},
    {"functional", {"function"}},
    {"future", {"future"}},
    {"initializer_list", {"initializer_list"}},
    {"limits", {"numeric_limits"}},
    {"map", {"map"}},
    {"memory", {"make_shared", "make_unique", "shared_ptr", "unique_ptr"}},
    {"mutex", {"mutex"}},
    {"optional", {"nullopt", "optional"}},
    {"random", {"mt19937"}},
    {"set", {"set"}},
    {"span", {"span"}},
    {"stdexcept", {"invalid_argument", "out_of_range", "runtime_error"}},
    {"string", {"string", "to_string"}},
    {"string_view", {"string_view"}},
    {"system_error", {"system_error"}},
    {"tuple", {"tuple"}},
    {"variant", {"get_if", "variant", "visit"}},
    {"vector", {"vector"}},
};

/// What CompileAlone has compiled before, so that it does not see where an include is missing (verify/CMakeLists.txt).
struct PrecompiledLibrary {
  std::string_view folder, names;
};
constexpr PrecompiledLibrary precompiled_libraries[] = {
    {"Eigen/", "Eigen::"}, {"CLI/", "CLI::"}, {"nlohmann/", "nlohmann::"}, {"toml++/", "toml::"}};

std::string from_sources(const std::string& header) {
  std::ifstream file(std::filesystem::path(DRAPE_SOURCE_DIR) / header);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// std::regex would do, but g++ 12 warns of its insides in builds with sanitizers.
std::vector<std::string> lines_of_code(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line.substr(0, line.find("//")));
  return lines;
}

/// All that a header of ours includes, itself and by headers of ours, other libraries' and the standard's.
void gather(const std::string& header, const Read& read, std::set<std::string>& included) {
  constexpr std::string_view include = "#include ";
  for (const std::string& line : lines_of_code(read(header))) {
    if (!line.starts_with(include)) continue;
    const std::size_t end = line.find_first_of(">\"", include.size() + 1);
    const std::string other = line.substr(include.size() + 1, end - include.size() - 1);
    if (included.insert(other).second && line[include.size()] == '"') gather(other, read, included);
  }
}

bool uses(const std::string& line, const std::string& name) {
  const std::string whole = "std::" + name;
  for (std::size_t at = line.find(whole); at != std::string::npos; at = line.find(whole, at + 1)) {
    const std::size_t end = at + whole.size();
    if (end == line.size() || (std::isalnum(static_cast<unsigned char>(line[end])) == 0 && line[end] != '_')) return true;
  }
  return false;
}

/// What a header uses but does not include: other libraries may include it, but need not.
std::vector<std::string> missing(const std::string& header, const Read& read) {
  std::set<std::string> included;
  gather(header, read, included);
  const std::vector<std::string> code = lines_of_code(read(header));
  const auto in_code = [&](const auto& found) { return std::ranges::any_of(code, found); };
  std::vector<std::string> lacking;
  for (const auto& [standard, names] : standard_headers) {
    const auto used = [&](const std::string& name) {
      return in_code([&](const std::string& line) { return uses(line, name); });
    };
    if (!included.contains(standard) && std::ranges::any_of(names, used))
      lacking.push_back(fmt::format("{} does not include <{}>", header, standard));
  }
  for (const PrecompiledLibrary& library : precompiled_libraries) {
    const auto is_of = [&](const std::string& name) { return name.starts_with(library.folder); };
    const auto names = [&](const std::string& line) { return line.find(library.names) != std::string::npos; };
    if (std::ranges::none_of(included, is_of) && in_code(names))
      lacking.push_back(fmt::format("{} does not include <{}…>", header, library.folder));
  }
  return lacking;
}

TEST(Headers, IncludeWhatTheyUseOfTheStandardLibrary) {
  int count = 0;
  for (const char* folder : {"solver", "model", "reference", "results", "bench"}) {
    const std::filesystem::path root = DRAPE_SOURCE_DIR;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".hpp") continue;
      EXPECT_THAT(missing(entry.path().lexically_relative(root).generic_string(), from_sources), IsEmpty());
      ++count;
    }
  }
  EXPECT_GT(count, 150);
}

/// With Eigen at hand, which all of them would take long to read each for itself: what Eigen includes is checked above.
TEST(Headers, CompileAlone) {
  DRAPE_SLOW();
  const ProgramResult result = run_program({.program = DRAPE_CMAKE,
                                            .arguments = {"--build", ".", "--target", "headers"},
                                            .folder = DRAPE_BINARY_DIR,
                                            .environment = {},
                                            .output = {}});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

std::vector<std::string> missing_in(const std::string& text, const std::string& other = "") {
  return missing("a.hpp", [&](const std::string& header) { return header == "a.hpp" ? text : other; });
}

TEST(HeadersChecker, ReportsWhatIsNotIncluded) {
  EXPECT_THAT(missing_in("std::vector<int> a();"), ElementsAre("a.hpp does not include <vector>"));
  EXPECT_THAT(missing_in("#include <fmt/format.h>\nstd::string a();"), ElementsAre("a.hpp does not include <string>"));
  EXPECT_THAT(missing_in("// #include <span>\nstd::span<int> a();"), ElementsAre("a.hpp does not include <span>"));
  EXPECT_THAT(missing_in("Eigen::Vector3d a();"), ElementsAre("a.hpp does not include <Eigen/…>"));
  EXPECT_THAT(missing_in("#include <Eigen/Core>\nvoid a(CLI::App& app);"), ElementsAre("a.hpp does not include <CLI/…>"));
  EXPECT_THAT(missing_in("void a(const toml::node& node);"), ElementsAre("a.hpp does not include <toml++/…>"));
}

TEST(HeadersChecker, AcceptsWhatIsIncludedByTheHeaderOrAnotherOfOurs) {
  EXPECT_THAT(missing_in("#include <vector>\nstd::vector<int> a();"), IsEmpty());
  EXPECT_THAT(missing_in("#include \"b.hpp\"\nstd::vector<int> a();", "#include <vector>\n"), IsEmpty());
  EXPECT_THAT(missing_in("/// A std::vector.\nint a(const std::vectors& b);"), IsEmpty());
}

}  // namespace
}  // namespace drape::verify::headers_test
