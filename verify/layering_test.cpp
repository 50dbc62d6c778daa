// Includes go one way only:  solver <- model, reference, results <- verify, bench;  and three libraries have one place each.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace drape::verify::layering_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// For every folder, the folders it may include.
const std::map<std::string, std::vector<std::string>> layers = {
    {"solver", {"solver"}},
    {"model", {"solver", "model"}},
    {"reference", {"solver", "reference"}},
    {"results", {"solver", "results"}},
    {"verify", {"solver", "model", "reference", "results", "verify"}},
    {"bench", {"solver", "model", "reference", "results", "bench"}},
};

/// A library whose headers begin with one of `prefixes` is for the files whose names begin with one of `places`.
struct Confined {
  std::vector<std::string> prefixes;
  std::vector<std::string> places;
};
const std::vector<Confined> confined_libraries = {
    {{"hdf5", "H5"}, {"results/hdf5"}},
    {{"arkode/", "cvode/", "cvodes/", "ida/", "idas/", "kinsol/", "sundials/", "nvector/", "sunmatrix/", "sunlinsol/",
      "sunnonlinsol/"},
     {"verify/state_vector_test.cpp", "reference/"}},
    {{"cholmod", "suitesparse/cholmod", "Eigen/CholmodSupport"}, {"solver/"}},
    {{"klu", "suitesparse/klu"}, {"reference/"}},
    {{"assimp/", "unsupported/Eigen/BVH"}, {"model/mesh_shape.cpp"}},
};

/// The text without its comments; "//" in a string is none.
std::string without_comments(std::string_view text) {
  std::string code;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    if (!in_string && rest.starts_with("//")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (!in_string && rest.starts_with("/*")) {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string_view::npos ? text.size() : end + 2;
    } else {
      if (text[i] == '"') in_string = !in_string;
      if (text[i] == '\n') in_string = false;
      const std::size_t length = rest.starts_with('\\') ? std::min<std::size_t>(2, rest.size()) : 1;
      code += rest.substr(0, length);
      i += length;
    }
  }
  return code;
}

/// The header that a line of code includes, with its quotes or angle brackets; "" if it includes none.
std::string_view included_header(std::string_view line) {
  for (const std::string_view word : {"", "#", "include"}) {
    if (!line.starts_with(word)) return "";
    line.remove_prefix(word.size());
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  }
  if (!line.starts_with('"') && !line.starts_with('<')) return "";
  return line.substr(0, line.find_first_of("\">", 1) + 1);
}

/// The first folder of a path, "" if it has none.
std::string top_folder(const std::string& path) {
  const std::size_t slash = path.find('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

/// What is wrong with the includes of a file: `name` is its path from the root, as in "model/cloth.cpp", `text` its content.
std::vector<std::string> wrong_includes(const std::string& name, const std::string& text) {
  const std::vector<std::string>& allowed = layers.at(top_folder(name));
  std::vector<std::string> wrong;
  std::istringstream code(without_comments(text));
  for (std::string line; std::getline(code, line);) {
    const std::string_view include = included_header(line);
    if (include.empty()) continue;
    const std::string header(include.substr(1, include.size() - 2));
    const bool ours = layers.contains(top_folder(header));
    if (ours && std::ranges::find(allowed, top_folder(header)) == allowed.end()) {
      wrong.push_back(fmt::format("{} includes {}, but may include only {}", name, header, fmt::join(allowed, ", ")));
    }
    if (ours != include.starts_with('"')) {
      wrong.push_back(fmt::format("{} includes {}: quotes are for our headers, from the root; <> for all else", name, header));
    }
    for (const auto& [prefixes, places] : confined_libraries) {
      const auto begins = [](std::string_view path) {
        return [=](const std::string& prefix) { return path.starts_with(prefix); };
      };
      if (std::ranges::any_of(prefixes, begins(header)) && std::ranges::none_of(places, begins(name))) {
        wrong.push_back(fmt::format("{} includes {}, which is for {} only", name, header, fmt::join(places, " and ")));
      }
    }
  }
  return wrong;
}

/// The sources under a folder of the tree, as paths from the root.
std::vector<std::string> sources(const std::string& folder) {
  const std::filesystem::path root = DRAPE_SOURCE_DIR;
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".hpp" || extension == ".cpp") found.push_back(entry.path().lexically_relative(root).generic_string());
  }
  return found;
}

std::string read(const std::string& name) {
  std::ifstream file(std::filesystem::path(DRAPE_SOURCE_DIR) / name);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Layering, IncludesGoOneWayOnly) {
  for (const auto& [folder, allowed] : layers) {
    const std::vector<std::string> names = sources(folder);
    EXPECT_THAT(names, Not(IsEmpty())) << folder;
    for (const std::string& name : names) {
      const std::string text = read(name);
      EXPECT_THAT(text, Not(IsEmpty())) << name << " was not read";
      EXPECT_THAT(wrong_includes(name, text), IsEmpty());
    }
  }
}

TEST(LayeringChecker, KnowsEveryDirection) {
  const std::set<std::string> middle = {"model", "reference", "results"}, top = {"verify", "bench"};
  for (const auto& [from, from_allowed] : layers) {
    for (const auto& [to, to_allowed] : layers) {
      const bool right = from == to || to == "solver" || (top.contains(from) && middle.contains(to));
      const auto wrong = wrong_includes(from + "/a.cpp", "#pragma once\n#include \"" + to + "/b.hpp\"\n");
      EXPECT_EQ(wrong.empty(), right) << from << " includes " << to;
    }
  }
}

TEST(LayeringChecker, SaysWhatMayBeIncluded) {
  EXPECT_THAT(wrong_includes("model/forces/a.cpp", "#include \"results/b.hpp\"\n"),
              ElementsAre("model/forces/a.cpp includes results/b.hpp, but may include only solver, model"));
}

TEST(LayeringChecker, ReportsAngleBracketsToo) {
  EXPECT_THAT(wrong_includes("solver/a.cpp", " #  include <model/b.hpp>\n"), Contains(HasSubstr("may include only solver")));
}

TEST(LayeringChecker, ReportsPathsThatHideTheFolder) {
  EXPECT_THAT(wrong_includes("solver/a.cpp", "#include \"../model/b.hpp\"\n"), ElementsAre(HasSubstr("from the root")));
  EXPECT_THAT(wrong_includes("solver/a.cpp", "#include \"b.hpp\"\n"), ElementsAre(HasSubstr("from the root")));
}

TEST(LayeringChecker, AcceptsLibrariesInTheirPlace) {
  EXPECT_THAT(wrong_includes("solver/cholesky.cpp", "#include <Eigen/Dense>\n#include <cholmod.h>\n"), IsEmpty());
  EXPECT_THAT(wrong_includes("reference/cvode.cpp", "#include <cvode/cvode.h>\n"), IsEmpty());
  EXPECT_THAT(wrong_includes("results/hdf5.cpp", "#include <hdf5.h>\n"), IsEmpty());
}

TEST(LayeringChecker, ReportsLibrariesOutOfTheirPlace) {
  EXPECT_THAT(wrong_includes("results/tables.cpp", "#include <hdf5.h>\n"), ElementsAre(HasSubstr("results/hdf5 only")));
  EXPECT_THAT(wrong_includes("verify/a_test.cpp", "#include <H5Cpp.h>\n"), ElementsAre(HasSubstr("results/hdf5 only")));
  for (const std::string header :
       {"cvode/cvode.h", "arkode/arkode_arkstep.h", "ida/ida.h", "kinsol/kinsol.h", "sundials/sundials_types.h",
        "nvector/nvector_serial.h", "sunmatrix/sunmatrix_sparse.h", "sunlinsol/sunlinsol_klu.h", "cvodes/cvodes.h",
        "idas/idas.h", "sunnonlinsol/sunnonlinsol_newton.h"}) {
    EXPECT_THAT(wrong_includes("bench/main.cpp", "#include <" + header + ">\n"), ElementsAre(HasSubstr("reference/ only")));
  }
  for (const std::string header : {"cholmod.h", "suitesparse/cholmod.h", "Eigen/CholmodSupport"}) {
    EXPECT_THAT(wrong_includes("model/cloth.cpp", "#include <" + header + ">\n"), ElementsAre(HasSubstr("solver/ only")));
  }
}

TEST(LayeringChecker, IgnoresCommentsButNotWhatFollowsThem) {
  EXPECT_THAT(wrong_includes("solver/a.cpp", "// #include \"model/b.hpp\"\n/*\n#include \"model/b.hpp\"\n*/\n"), IsEmpty());
  EXPECT_THAT(wrong_includes("solver/a.cpp", "char quote = '\"';\n/*\n#include \"model/b.hpp\"\n*/\n"), IsEmpty());
  EXPECT_THAT(wrong_includes("solver/a.cpp", "/* one */ #include \"model/b.hpp\"  // two\n"), SizeIs(1));
  EXPECT_THAT(wrong_includes("solver/a.cpp", "// /*\n#include \"model/b.hpp\"\n"), SizeIs(1));
  EXPECT_THAT(wrong_includes("solver/a.cpp", "auto s = \"/*\\\"/*\";\n#include \"model/b.hpp\"\n// */\n"), SizeIs(1));
}

}  // namespace
}  // namespace drape::verify::layering_test
