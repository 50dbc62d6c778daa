// bench_integrators run --frames: the meshes that it writes are the sheet and its obstacles.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::frames_test {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

const Words tiny{"run", "--scene", "hung-edge", "--set", "grid.n=[5, 4]", "--until", "0.05", "--no-reference", "--repeat", "1"};

/// A file as it is read by a program that knows only the format.
struct Obj {
  double t = 0;
  std::vector<Vector3d> vertices;
  std::vector<std::vector<int>> faces, lines;  ///< corners, counted from 0

  explicit Obj(const std::string& text) {
    EXPECT_THAT(text, StartsWith("# t = "));
    t = std::stod(text.substr(6));
    for (const std::string& line : split(text, '\n')) {
      std::istringstream words(line.substr(std::min<std::size_t>(1, line.size())));
      Vector3d v;
      std::vector<int> corners;
      if (line.starts_with("v ") && words >> v[0] >> v[1] >> v[2]) vertices.push_back(v);
      if (!line.starts_with("f ") && !line.starts_with("l ")) continue;
      for (int corner = 0; words >> corner;) corners.push_back(corner - 1);
      (line[0] == 'f' ? faces : lines).push_back(corners);
    }
  }
};

/// Paths of the meshes under a folder.
Words meshes(const BenchIntegrators& program) {
  Words found;
  for (const auto& [name, content] : program.files())
    if (name.ends_with(".obj")) found.push_back(name);
  return found;
}

Obj mesh(const BenchIntegrators& program, const std::string& name) { return Obj(program.files().at(name)); }

TEST(Frames, ShowEveryRunFromItsStartAtTheTimesAskedFor) {
  const BenchIntegrators program;
  program.output(tiny + Words{"--method", "bdf2,sbdf2/cholesky", "--step", "0.005", "--frames", "a/b", "--every", "0.02"});
  const std::string bdf2 = "a/b/hung-edge-bdf2-0.005/", sbdf2 = "a/b/hung-edge-sbdf2-cholesky-0.005/";
  EXPECT_THAT(meshes(program), ElementsAre(bdf2 + "sheet-0000.obj", bdf2 + "sheet-0001.obj", bdf2 + "sheet-0002.obj",
                                           sbdf2 + "sheet-0000.obj", sbdf2 + "sheet-0001.obj", sbdf2 + "sheet-0002.obj"));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mesh(program, bdf2 + "sheet-000" + std::to_string(k) + ".obj").t, 0.02 * k, 1e-15);
}

TEST(Frames, AreAtMostOneAStep) {
  const BenchIntegrators program;
  program.output(tiny + Words{"--method", "bdf2", "--step", "0.02", "--frames", "a", "--every", "0.003"});
  std::vector<double> times;
  for (const std::string& name : meshes(program)) times.push_back(mesh(program, name).t);
  EXPECT_THAT(times, ElementsAre(0, 0.02, 0.04, 0.05));
}

TEST(Frames, ShowEveryParticleAndEveryCell) {
  const BenchIntegrators program;
  program.output(tiny + Words{"--method", "bdf2", "--step", "0.01", "--frames", "a"});
  const Obj start = mesh(program, "a/hung-edge-bdf2-0.01/sheet-0000.obj");
  const Obj later = mesh(program, "a/hung-edge-bdf2-0.01/sheet-0001.obj");
  const model::Scene scene = model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", "[5, 4]"}});
  const solver::Vectors x = compile(scene).start.x;
  ASSERT_EQ(start.vertices.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(start.vertices[i], Vector3d(x.row(i)));
  ASSERT_EQ(start.faces.size(), 12u);
  EXPECT_THAT(start.faces[0], ElementsAre(0, 1, 6, 5));
  EXPECT_THAT(start.faces[11], ElementsAre(13, 14, 19, 18));
  EXPECT_EQ(later.faces, start.faces);
  EXPECT_LT(later.vertices[0][2], -1e-4);  // it falls
}

/// Four particles over a box: the faces that it divides, and its edges among theirs.
TEST(Frames, ShowVirtualParticlesBesideTheSheet) {
  const BenchIntegrators program;
  program.output({"run", "--scene", "box_four", "--method", "implicit-euler", "--step", "0.01", "--until", "0.2", "--every",
                  "0.1", "--no-reference", "--repeat", "1", "--frames", "a"});
  const std::string folder = "a/box_four-implicit-euler-0.01/";
  const auto refined = [&](int k) { return mesh(program, fmt::format("{}refined-{:04}.obj", folder, k)); };
  EXPECT_EQ(refined(0).vertices.size(), 4U) << "nothing is divided at the start";
  EXPECT_EQ(refined(0).faces.size(), 2U);
  const Obj last = refined(2), sheet = mesh(program, folder + "sheet-0002.obj");
  EXPECT_EQ(last.t, sheet.t);
  EXPECT_EQ(sheet.vertices.size(), 4U);
  EXPECT_GE(last.vertices.size(), 10U) << "two on each of two springs, and where edges cross the diagonal of the cell";
  for (std::size_t k = 0; k < last.vertices.size(); ++k) {
    if (k < 4) {
      EXPECT_EQ(last.vertices[k], sheet.vertices[k]);
    } else {
      EXPECT_NEAR(last.vertices[k].z(), -0.03, 1e-12) << "on top of the box";
    }
  }
}

/// The scene names a mesh, which rides on the sheet.
TEST(Frames, ShowWhatTheSheetIsTrimmedTo) {
  const BenchIntegrators program;
  write_mesh(program.folder() / "part.obj",
             {.name = "", .vertices = {{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}}, .triangles = {{0, 1, 2}}});
  program.output(tiny + Words{"--method", "bdf2", "--step", "0.01", "--frames", "a", "--set", "trim.file=part.obj"});
  const Obj start = mesh(program, "a/hung-edge-bdf2-0.01/sheet-0000.obj");
  const Obj later = mesh(program, "a/hung-edge-bdf2-0.01/sheet-0001.obj");
  EXPECT_THAT(start.faces, ElementsAre(ElementsAre(0, 1, 2)));
  EXPECT_THAT(start.vertices, ElementsAre(Vector3d(0, 0, 0), Vector3d(0.25, 0, 0), Vector3d(0, 0.25, 0)));
  EXPECT_EQ(later.faces, start.faces);
  EXPECT_LT(later.vertices[0][2], -1e-4);  // it falls
}

/// Panels keep their outlines, sewn or not.
TEST(Frames, OfGarmentsShowWhatTheyAreTrimmedTo) {
  DRAPE_SLOW();
  const BenchIntegrators program;
  program.output({"run", "--scene", "sewn_dress", "--set", "trim.outline=true", "--until", "0.42", "--no-reference", "--repeat",
                  "1", "--method", "imex-euler", "--step", "0.02", "--frames", "a", "--every", "0.42"});
  const Obj start = mesh(program, "a/sewn_dress-imex-euler-0.02/sheet-0000.obj");
  const Obj sewn = mesh(program, "a/sewn_dress-imex-euler-0.02/sheet-0001.obj");
  EXPECT_EQ(sewn.vertices.size(), start.vertices.size());
  EXPECT_EQ(sewn.faces, start.faces);
  EXPECT_THAT(start.faces, testing::Each(testing::SizeIs(3)));
  const auto distance = [](const Vector3d& vertex) { return (vertex - Vector3d(-0.45, -0.3, 0.45)).norm(); };
  const auto hem = std::ranges::min_element(start.vertices, {}, distance);  // the left end of that of the front
  EXPECT_LE(distance(*hem), 1e-12);
  EXPECT_NEAR(sewn.vertices.at(static_cast<std::size_t>(hem - start.vertices.begin())).y(), 0, 0.01) << "its side is sewn";
}

TEST(Frames, ShowChainsAsLines) {
  const BenchIntegrators program;
  program.output({"run", "--scene", "chain", "--set", "grid.n=[4, 1]", "--until", "0.01", "--no-reference", "--repeat", "1",
                  "--method", "bdf2", "--step", "0.01", "--frames", "a"});
  const Obj chain = mesh(program, "a/chain-bdf2-0.01/sheet-0000.obj");
  EXPECT_EQ(chain.vertices.size(), 4u);
  EXPECT_TRUE(chain.faces.empty());
  EXPECT_THAT(chain.lines, ElementsAre(ElementsAre(0, 1), ElementsAre(1, 2), ElementsAre(2, 3)));
}

const std::string obstacles = R"(
name = "all/obstacles"
[grid]
n = 3
[material]
tension = 100
[forces]
gravity = [0, 0, -1]
[[pins]]
where = "left edge"
[[obstacles]]
shape = "plane"
position = [0, 0, -1]
rotation = [20, 0, 0]
[[obstacles]]
shape = "sphere"
radius = 0.3
position = [0, 0, -2]
[[obstacles]]
shape = "box"
size = [0.1, 0.2, 0.3]
motion = [{ time = 0, position = [0, 0, -3] }, { time = 0.04, position = [0.4, 0, -3], rotation = [0, 0, 90] }]
[[obstacles]]
shape = "cylinder"
radius = 0.5
height = 0.1
position = [0, 0, -4]
[[obstacles]]
shape = "mesh"
file = "tetrahedron.obj"
scale = 0.5
position = [0, 0, -5]
)";
const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

Vector3d centre(const Obj& obj, const std::vector<int>& face) {
  Vector3d sum = Vector3d::Zero();
  for (const int corner : face) sum += obj.vertices[corner];
  return sum / static_cast<double>(face.size());
}

TEST(Frames, ShowTheSurfacesOfObstaclesWhereTheyAreFromOutside) {
  const BenchIntegrators program;
  program.write("tetrahedron.obj", tetrahedron);
  program.write("all.toml", obstacles);
  program.output({"run", "--scene", "all.toml", "--until", "0.04", "--no-reference", "--repeat", "1", "--method", "bdf2",
                  "--step", "0.01", "--frames", "a"});
  const model::Scene scene = model::load_scene((program.folder() / "all.toml").string());
  const std::size_t faces[] = {1, 48 * 23 + 2, 6, 48 + 2, 4};
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    for (const std::string frame : {"0000", "0001"}) {
      const Obj obj = mesh(program, "a/all-obstacles-bdf2-0.01/obstacle-" + std::to_string(k) + "-" + frame + ".obj");
      EXPECT_EQ(obj.faces.size(), faces[k]);
      const model::Obstacle obstacle(scene.obstacles[k]);
      const model::Pose pose = obstacle.pose(obj.t);
      for (const Vector3d& v : obj.vertices) EXPECT_NEAR(obstacle.nearest(pose.to_body(v)).distance, 0, 1e-14) << k;
      for (const std::vector<int>& f : obj.faces) {
        const auto& x = obj.vertices;
        const Vector3d out = (x[f[1]] - x[f[0]]).cross(x[f[2]] - x[f[1]]).normalized();
        EXPECT_GT(obstacle.nearest(pose.to_body(centre(obj, f) + 0.02 * out)).distance, 0.01) << k;
      }
    }
}

/// Vertices are nodes: those that a seam has merged are one, and cells on both sides of it have them.
TEST(Frames, OfGarmentsShowWhatIsSewn) {
  const BenchIntegrators program;
  program.output({"run", "--scene", "sewn_dress", "--until", "0.62", "--no-reference", "--repeat", "1", "--method",
                  "imex-euler", "--step", "0.02", "--frames", "a", "--every", "0.2"});
  for (int k = 0; k < 4; ++k) {
    const Obj sheet = mesh(program, fmt::format("a/sewn_dress-imex-euler-0.02/sheet-000{}.obj", k));
    EXPECT_EQ(sheet.vertices.size(), k < 3 ? 2 * 25 * 38 : 2 * 25 * 38 - 2 * 28 - 2 * 5) << k;
    EXPECT_EQ(sheet.faces.size(), 2 * 24 * 37);
    std::vector<int> uses(sheet.vertices.size());
    for (const std::vector<int>& face : sheet.faces)
      for (const int corner : face) ++uses.at(static_cast<std::size_t>(corner));
    EXPECT_EQ(std::ranges::count(uses, 0), 0) << k;
  }
}

}  // namespace
}  // namespace drape::verify::frames_test
