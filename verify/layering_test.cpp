// Includes go one way only, between folders and between the rooms inside them; and some libraries have one place each.

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

/// A part of the sources: files whose paths begin with one of `files`, the longest such beginning counts. They may include each
/// other, the rooms in `below` and what these may include.
struct Room {
  std::string name;
  std::vector<std::string> files;
  std::vector<std::string> below;
};

/// From the ground up.
const std::vector<Room> rooms = {
    {"solver/base", {"solver/base/"}, {}},
    {"solver's vocabulary",
     {"solver/counters.", "solver/filter.", "solver/memory.", "solver/outcome.", "solver/split_ode.", "solver/stage.",
      "solver/partition.", "solver/state.", "solver/step_forces."},
     {"solver/base"}},
    {"solver/linear", {"solver/linear/"}, {"solver's vocabulary"}},
    {"solver/contact", {"solver/contact/"}, {"solver's vocabulary"}},
    {"solver's options", {"solver/options."}, {"solver/linear"}},
    {"solver/stage", {"solver/stage/"}, {"solver's options", "solver/contact"}},
    {"solver", {"solver/"}, {"solver/stage"}},
    {"solver/methods", {"solver/methods/"}, {"solver"}},

    {"model/memory", {"model/memory/"}, {"solver"}},
    {"model/sheet", {"model/sheet/"}, {"model/memory"}},
    {"model/forces/fused", {"model/forces/fused/"}, {"model/sheet"}},
    {"model/forces", {"model/forces/"}, {"model/forces/fused"}},
    {"model/jacobian", {"model/jacobian/"}, {"model/forces"}},
    {"model/keys", {"model/keys/"}, {"model/sheet"}},
    {"model/obstacles", {"model/obstacles/"}, {"model/keys"}},
    {"model/obstacles/shapes", {"model/obstacles/shapes/"}, {"model/obstacles"}},
    {"model's scenes",
     {"model/scene.", "model/garment.", "model/outline_mesh.", "model/trimmed_surface."},
     {"model/forces", "model/obstacles"}},
    {"model/collision", {"model/collision/"}, {"model's scenes"}},
    {"model/adaptive", {"model/adaptive/"}, {"model/collision"}},
    {"model", {"model/"}, {"model/jacobian", "model/obstacles/shapes", "model/adaptive"}},
    {"model/scene_file", {"model/scene_file/"}, {"model"}},
    {"model/pattern", {"model/pattern/"}, {"model/scene_file"}},

    {"reference's vocabulary",
     {"reference/newton_solves.", "reference/tableaux.", "reference/trajectory.", "reference/distance."},
     {"solver"}},
    {"reference/sundials", {"reference/sundials/"}, {"reference's vocabulary"}},
    {"reference/exact", {"reference/exact/"}, {"solver"}},
    {"reference/theory", {"reference/theory/"}, {"reference/exact"}},
    {"reference", {"reference/"}, {"reference/sundials", "reference/theory"}},

    {"results", {"results/"}, {"solver"}},
    {"results/file", {"results/file/"}, {"results"}},
    {"results/analysis", {"results/analysis/"}, {"results/file"}},

    {"bench/runs", {"bench/runs/"}, {"model/scene_file", "reference", "results/analysis"}},
    {"bench/peers", {"bench/peers/"}, {"bench/runs"}},
    {"bench/peers/programs", {"bench/peers/programs/"}, {"bench/peers"}},
    {"bench/strips", {"bench/strips/"}, {"bench/runs"}},
    {"bench/strips/programs", {"bench/strips/programs/"}, {"bench/strips"}},
    {"bench/studies", {"bench/studies/"}, {"bench/peers", "bench/strips"}},
    {"bench/report", {"bench/report/"}, {"bench/runs"}},
    {"bench/score", {"bench/score/"}, {"bench/studies"}},
    {"bench/commands", {"bench/commands/"}, {"bench/score", "bench/report", "model/pattern"}},
    {"bench/kernels", {"bench/kernels/"}, {"model/scene_file"}},
    {"bench/python", {"bench/python/"}, {"bench/commands"}},
    {"bench", {"bench/"}, {"bench/commands"}},

    {"verify", {"verify/"}, {"bench", "solver/methods"}},
};

const Room& room_named(const std::string& name) { return *std::ranges::find(rooms, name, &Room::name); }

/// The room of a file, nullptr if it is none of ours.
const Room* room_of(const std::string& path) {
  const Room* found = nullptr;
  std::size_t longest = 0;
  for (const Room& room : rooms) {
    for (const std::string& beginning : room.files) {
      if (!path.starts_with(beginning) || beginning.size() <= longest) continue;
      found = &room;
      longest = beginning.size();
    }
  }
  return found;
}

/// Whether files of the one may include files of the other.
bool may_include(const Room& from, const Room& to) {
  return &from == &to ||
         std::ranges::any_of(from.below, [&](const std::string& name) { return may_include(room_named(name), to); });
}

/// A library whose headers begin with one of `prefixes` is for the files whose names begin with one of `places`.
struct Confined {
  std::vector<std::string> prefixes;
  std::vector<std::string> places;
};
const std::vector<Confined> confined_libraries = {
    {{"hdf5", "H5"}, {"results/file/hdf5"}},
    {{"arkode/", "cvode/", "cvodes/", "ida/", "idas/", "kinsol/", "sundials/", "nvector/", "sunmatrix/", "sunlinsol/",
      "sunnonlinsol/"},
     {"verify/reference/sundials/state_vector_test.cpp", "bench/strips/programs/cvode.cpp", "reference/sundials/"}},
    {{"cholmod", "suitesparse/cholmod", "Eigen/CholmodSupport"}, {"solver/linear/"}},
    {{"klu", "suitesparse/klu"}, {"solver/linear/klu_factor.cpp"}},
    {{"assimp/"}, {"model/obstacles/mesh_file.cpp"}},
    {{"CGAL/"}, {"model/outline_mesh.cpp", "model/adaptive/face_triangulation.cpp", "model/collision/exact_intersection.cpp"}},
    {{"glpk.h"}, {"model/pattern/quad_layout.cpp"}},
    {{"bt", "BulletSoftBody/"}, {"bench/peers/programs/bullet.cpp"}},
    {{"petsc"}, {"bench/peers/programs/petsc.cpp"}},
    {{"mpi.h", "HYPRE"}, {"bench/strips/programs/"}},
    {{"unsupported/Eigen/BVH"}, {"model/trimmed_surface.cpp"}},
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

/// What is wrong with the includes of a file: `name` is its path from the root, as in "model/cloth.cpp", `text` its content.
std::vector<std::string> wrong_includes(const std::string& name, const std::string& text) {
  const Room& room = *room_of(name);
  std::vector<std::string> wrong;
  std::istringstream code(without_comments(text));
  for (std::string line; std::getline(code, line);) {
    const std::string_view include = included_header(line);
    if (include.empty()) continue;
    const std::string header(include.substr(1, include.size() - 2));
    const Room* const included = room_of(header);
    if (included && !may_include(room, *included)) {
      wrong.push_back(fmt::format("{} includes {}: {} is not below {}", name, header, included->name, room.name));
    }
    if ((included != nullptr) != include.starts_with('"')) {
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
  std::set<std::string> seen;
  for (const char* folder : {"solver", "model", "reference", "results", "bench", "verify"}) {
    for (const std::string& name : sources(folder)) {
      seen.insert(room_of(name)->name);
      const std::string text = read(name);
      EXPECT_THAT(text, Not(IsEmpty())) << name << " was not read";
      EXPECT_THAT(wrong_includes(name, text), IsEmpty());
    }
  }
  for (const Room& room : rooms) EXPECT_TRUE(seen.contains(room.name)) << room.name << " has no files";
}

/// A room knows only rooms that stand before it, so that there is no cycle.
TEST(Layering, GoesFromTheGroundUp) {
  for (const Room& room : rooms) {
    for (const std::string& name : room.below) EXPECT_LT(&room_named(name), &room) << room.name << " and " << name;
  }
}

std::vector<std::string> include_of(const std::string& header, const std::string& by) {
  return wrong_includes(by, "#pragma once\n#include \"" + header + "\"\n");
}

TEST(LayeringChecker, KnowsTheOrderOfFolders) {
  const std::set<std::string> middle = {"model", "reference", "results"};
  const std::vector<std::string> folders = {"solver", "model", "reference", "results", "bench", "verify"};
  for (const std::string& from : folders) {
    for (const std::string& to : folders) {
      const bool right = from == to || to == "solver" || from == "verify" || (from == "bench" && middle.contains(to));
      EXPECT_EQ(include_of(to + "/b.hpp", from + "/a.cpp").empty(), right) << from << " includes " << to;
    }
  }
}

TEST(LayeringChecker, KnowsTheOrderInsideFolders) {
  const std::vector<std::vector<std::string>> chains = {
      {"solver/base/a.hpp", "solver/state.hpp", "solver/linear/a.hpp", "solver/options.hpp", "solver/stage/a.hpp",
       "solver/a.hpp", "solver/methods/a.hpp"},
      {"model/memory/a.hpp", "model/sheet/a.hpp", "model/forces/fused/a.hpp", "model/forces/a.hpp", "model/jacobian/a.hpp",
       "model/a.hpp", "model/scene_file/a.hpp"},
      {"model/sheet/a.hpp", "model/keys/a.hpp", "model/obstacles/a.hpp", "model/obstacles/shapes/a.hpp", "model/a.hpp"},
      {"model/obstacles/a.hpp", "model/garment.hpp", "model/collision/a.hpp", "model/a.hpp"},
      {"reference/trajectory.hpp", "reference/sundials/a.hpp", "reference/a.hpp"},
      {"reference/exact/a.hpp", "reference/theory/a.hpp", "reference/a.hpp"},
      {"results/a.hpp", "results/file/a.hpp", "results/analysis/a.hpp"},
      {"bench/runs/a.hpp", "bench/studies/a.hpp", "bench/score/a.hpp", "bench/commands/a.hpp"},
      {"bench/runs/a.hpp", "bench/report/a.hpp", "bench/commands/a.hpp"},
  };
  for (const std::vector<std::string>& chain : chains) {
    for (std::size_t i = 0; i < chain.size(); ++i) {
      for (std::size_t k = 0; k < chain.size(); ++k)
        EXPECT_EQ(include_of(chain[i], chain[k]).empty(), i <= k) << chain[k] << " includes " << chain[i];
    }
  }
}

TEST(LayeringChecker, KeepsRoomsBesideEachOtherApart) {
  const std::pair<std::string, std::string> apart[] = {{"solver/linear/a.hpp", "solver/contact/a.hpp"},
                                                       {"model/obstacles/a.hpp", "model/forces/a.hpp"},
                                                       {"reference/sundials/a.hpp", "reference/exact/a.hpp"},
                                                       {"bench/studies/a.hpp", "bench/report/a.hpp"},
                                                       {"bench/kernels/a.hpp", "bench/runs/a.hpp"}};
  for (const auto& [a, b] : apart) {
    EXPECT_THAT(include_of(a, b), SizeIs(1)) << b << " includes " << a;
    EXPECT_THAT(include_of(b, a), SizeIs(1)) << a << " includes " << b;
  }
}

TEST(LayeringChecker, NamesTheRooms) {
  EXPECT_THAT(include_of("results/b.hpp", "model/forces/a.cpp"),
              ElementsAre("model/forces/a.cpp includes results/b.hpp: results is not below model/forces"));
}

TEST(LayeringChecker, ReportsAngleBracketsToo) {
  EXPECT_THAT(wrong_includes("solver/a.cpp", " #  include <model/b.hpp>\n"), Contains(HasSubstr("model is not below solver")));
}

TEST(LayeringChecker, ReportsPathsThatHideTheFolder) {
  EXPECT_THAT(wrong_includes("solver/a.cpp", "#include \"../model/b.hpp\"\n"), ElementsAre(HasSubstr("from the root")));
  EXPECT_THAT(wrong_includes("solver/a.cpp", "#include \"b.hpp\"\n"), ElementsAre(HasSubstr("from the root")));
}

TEST(LayeringChecker, AcceptsLibrariesInTheirPlace) {
  EXPECT_THAT(wrong_includes("solver/linear/cholesky.cpp", "#include <Eigen/Dense>\n#include <cholmod.h>\n"), IsEmpty());
  EXPECT_THAT(wrong_includes("reference/sundials/cvode.cpp", "#include <cvode/cvode.h>\n"), IsEmpty());
  EXPECT_THAT(wrong_includes("results/file/hdf5.cpp", "#include <hdf5.h>\n"), IsEmpty());
}

TEST(LayeringChecker, ReportsLibrariesOutOfTheirPlace) {
  EXPECT_THAT(wrong_includes("results/tables.cpp", "#include <hdf5.h>\n"), ElementsAre(HasSubstr("results/file/hdf5 only")));
  EXPECT_THAT(wrong_includes("verify/a_test.cpp", "#include <H5Cpp.h>\n"), ElementsAre(HasSubstr("results/file/hdf5 only")));
  for (const std::string header :
       {"cvode/cvode.h", "arkode/arkode_arkstep.h", "ida/ida.h", "kinsol/kinsol.h", "sundials/sundials_types.h",
        "nvector/nvector_serial.h", "sunmatrix/sunmatrix_sparse.h", "sunlinsol/sunlinsol_klu.h", "cvodes/cvodes.h",
        "idas/idas.h", "sunnonlinsol/sunnonlinsol_newton.h"}) {
    EXPECT_THAT(wrong_includes("bench/main.cpp", "#include <" + header + ">\n"),
                ElementsAre(HasSubstr("reference/sundials/ only")));
  }
  for (const std::string header : {"cholmod.h", "suitesparse/cholmod.h", "Eigen/CholmodSupport"}) {
    EXPECT_THAT(wrong_includes("model/cloth.cpp", "#include <" + header + ">\n"),
                ElementsAre(HasSubstr("solver/linear/ only")));
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
