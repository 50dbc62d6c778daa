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
    {"algorithm",
     {"clamp", "copy", "equal", "find_if", "max", "min", "ranges::all_of", "ranges::find", "ranges::find_if", "rotate",
      "sort"}},
    {"any", {"any", "any_cast"}},
    {"array", {"array"}},
    {"atomic", {"atomic"}},
    {"cctype", {"isdigit", "islower"}},
    {"chrono", {"chrono", "milli"}},
    {"cmath", {"abs", "hypot", "isfinite", "isnan", "nan", "pow", "sqrt"}},
    {"complex", {"complex"}},
    {"concepts", {"integral", "signed_integral"}},
    {"cstddef", {"byte", "ptrdiff_t", "size_t"}},
    {"cstdint", {"int32_t", "int64_t", "uint8_t", "uint64_t", "uintmax_t"}},
    {"cstdio", {"fprintf"}},
    {"deque", {"deque"}},
    {"exception", {"current_exception", "exception", "exception_ptr"}},
    {"filesystem", {"filesystem"}},
    {"fstream", {"ifstream", "ofstream"}},
    {"functional", {"function"}},
    {"future", {"future"}},
    {"initializer_list", {"initializer_list"}},
    {"iosfwd", {"ostream"}},
    {"iterator", {"begin", "data", "end", "size", "ssize"}},
    {"limits", {"numeric_limits"}},
    {"map", {"map"}},
    {"memory", {"make_shared", "make_unique", "shared_ptr", "unique_ptr"}},
    {"memory_resource", {"pmr::memory_resource", "pmr::unsynchronized_pool_resource"}},
    {"mutex", {"lock_guard", "mutex"}},
    {"new", {"bad_alloc"}},
    {"numeric", {"iota"}},
    {"optional", {"nullopt", "optional"}},
    {"random", {"mt19937"}},
    {"ranges", {"ranges::input_range"}},
    {"set", {"set"}},
    {"span", {"as_bytes", "span"}},
    {"stdexcept", {"invalid_argument", "out_of_range", "runtime_error"}},
    {"string", {"string", "to_string"}},
    {"string_view", {"string_view"}},
    {"system_error", {"errc", "generic_category", "system_error"}},
    {"tuple", {"apply", "tie", "tuple"}},
    {"type_traits",
     {"conditional_t", "invoke_result_t", "is_const_v", "is_constructible_v", "is_same_v", "remove_pointer_t",
      "remove_reference_t", "type_identity"}},
    {"unordered_map", {"pmr::unordered_map"}},
    {"unordered_set", {"pmr::unordered_set"}},
    {"utility", {"cmp_equal", "exchange", "move", "pair", "swap"}},
    {"variant", {"get_if", "holds_alternative", "monostate", "variant", "visit"}},
    {"vector", {"pmr::vector", "vector"}},
};

/// What CompileAlone has compiled before, so that it does not see where an include is missing (verify/CMakeLists.txt).
struct PrecompiledLibrary {
  std::string_view folder, names;
};
constexpr PrecompiledLibrary precompiled_libraries[] = {
    {"Eigen/", "Eigen::"}, {"CLI/", "CLI::"},   {"nlohmann/", "nlohmann::"}, {"toml++/", "toml::"}, {"fmt/", "fmt::"},
    {"sundials/", "N_V"},  {"cvode/", "CVode"}, {"cholmod.h", "cholmod_"},   {"hdf5.h", "hid_t"},   {"omp.h", "omp_"},
};

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

constexpr std::string_view of_standard = "std::";

/// Whether a name is all that there is of an identifier from `at` on.
bool is_at(const std::string& line, std::size_t at, const std::string& name) {
  const std::size_t end = at + name.size();
  return line.compare(at, name.size(), name) == 0 &&
         (end == line.size() || (std::isalnum(static_cast<unsigned char>(line[end])) == 0 && line[end] != '_'));
}

/// Calls f with each place behind "std::".
void at_each_name(const std::string& line, const auto& f) {
  for (std::size_t at = line.find(of_standard); at != std::string::npos; at = line.find(of_standard, at + 1))
    f(at + of_standard.size());
}

bool uses(const std::string& line, const std::string& name) {
  bool found = false;
  at_each_name(line, [&](std::size_t at) { found = found || is_at(line, at, name); });
  return found;
}

/// What a line uses of the standard library that the table does not know.
std::vector<std::string> unknown(const std::string& line) {
  std::vector<std::string> all;
  at_each_name(line, [&](std::size_t at) {
    const auto is_here = [&](const std::string& name) { return is_at(line, at, name); };
    if (std::ranges::none_of(standard_headers, [&](const auto& header) { return std::ranges::any_of(header.second, is_here); }))
      all.push_back(line.substr(at));
  });
  return all;
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
  for (const std::string& line : code)
    for (const std::string& name : unknown(line)) lacking.push_back(fmt::format("{}: the table has no std::{}", header, name));
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
  EXPECT_THAT(missing_in("void a(std::vectors b);"), ElementsAre("a.hpp: the table has no std::vectors b);"));
  EXPECT_THAT(missing_in("void a(const toml::node& node);"), ElementsAre("a.hpp does not include <toml++/…>"));
}

TEST(HeadersChecker, AcceptsWhatIsIncludedByTheHeaderOrAnotherOfOurs) {
  EXPECT_THAT(missing_in("#include <vector>\nstd::vector<int> a();"), IsEmpty());
  EXPECT_THAT(missing_in("#include \"b.hpp\"\nstd::vector<int> a();", "#include <vector>\n"), IsEmpty());
  EXPECT_THAT(missing_in("/// A std::vector.\nint a(const vectors& b);"), IsEmpty());
}

}  // namespace
}  // namespace drape::verify::headers_test
