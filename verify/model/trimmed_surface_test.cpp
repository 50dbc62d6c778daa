// Triangle meshes that ride on a grid.

#include "model/trimmed_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

#include "model/garment.hpp"
#include "model/outline_mesh.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::trimmed_surface_test {
namespace {

using namespace sheets;
using Eigen::Vector3d;
using model::TriangleMesh;
using model::TrimmedSurface;

constexpr double rounding = 1e-13;

/// Vertices at random places between particles of the pattern.
TriangleMesh scattered(const Grid& grid, int count) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> part(0, 1);
  const Vectors pattern = grid.parameters();
  TriangleMesh mesh{.name = "scattered", .vertices = {}, .triangles = {}};
  for (int k = 0; k < count; ++k) {
    const int a = static_cast<int>(generator() % (grid.nu - 1)), b = static_cast<int>(generator() % (grid.nv - 1));
    const double s = part(generator), t = part(generator);
    const auto corner = [&](int i, int j) -> Vector3d { return pattern.row(grid.index(a + i, b + j)); };
    mesh.vertices.push_back((1 - s) * (1 - t) * corner(0, 0) + s * (1 - t) * corner(1, 0) + (1 - s) * t * corner(0, 1) +
                            s * t * corner(1, 1));
    if (k >= 2) mesh.triangles.push_back({k - 2, k - 1, k});
  }
  return mesh;
}

TEST(TrimmedSurface, MovesExactlyInHomogeneousStrains) {
  const Eigen::Matrix3d map = Eigen::Matrix3d{{1.1, 0.3, 0}, {0.2, 0.9, 0}, {0.1, -0.4, 1}};
  for (const Grid& grid : {five_by_four(), graded(), curved()}) {
    const TriangleMesh mesh = scattered(grid, 200);
    const TrimmedSurface surface(grid, mesh);
    const Vectors moved = grid.parameters() * map.transpose();
    const model::Polygons polygons = surface.at(moved);
    ASSERT_EQ(polygons.vertices.size(), mesh.vertices.size());
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k)
      EXPECT_LE((polygons.vertices[k] - map * mesh.vertices[k]).norm(), rounding);
    ASSERT_EQ(polygons.faces.size(), mesh.triangles.size());
    EXPECT_THAT(polygons.faces.back(), testing::ElementsAre(197, 198, 199));
  }
}

/// Inside of a half its point is that of the half's corners only.
TEST(TrimmedSurface, RidesOnTheHalfInWhichItLies) {
  const Grid grid{2, 2, 1, 1};
  const Vectors x = random_vectors(4, 1, 1);
  const TrimmedSurface surface(grid, {.name = "two", .vertices = {{0.2, 0.3, 0}, {0.9, 0.6, 0}}, .triangles = {}});
  const model::Polygons polygons = surface.at(x);
  const Eigen::RowVector3d lower_left = 0.5 * x.row(0) + 0.2 * x.row(1) + 0.3 * x.row(2);
  const Eigen::RowVector3d upper_right = 0.5 * x.row(3) + 0.4 * x.row(1) + 0.1 * x.row(2);
  EXPECT_LE((polygons.vertices[0].transpose() - lower_left).norm(), rounding);
  EXPECT_LE((polygons.vertices[1].transpose() - upper_right).norm(), rounding);
}

/// What two halves share gives the same point from both: particles, edges and diagonals.
TEST(TrimmedSurface, IsContinuousBetweenHalves) {
  for (const Grid& grid : {five_by_four(), curved()}) {
    const Vectors pattern = grid.parameters(), x = random_vectors(grid.particles(), 1, 2);
    TriangleMesh mesh{.name = "edges", .vertices = {}, .triangles = {}};
    std::vector<Eigen::RowVector3d> expected;
    const auto add = [&](int i, int j, double part) {
      mesh.vertices.emplace_back((1 - part) * pattern.row(i) + part * pattern.row(j));
      expected.emplace_back((1 - part) * x.row(i) + part * x.row(j));
    };
    for (int b = 0; b + 1 < grid.nv; ++b)
      for (int a = 0; a + 1 < grid.nu; ++a) {
        add(grid.index(a, b), grid.index(a + 1, b), 0.3);
        add(grid.index(a, b), grid.index(a, b + 1), 0.6);
        add(grid.index(a + 1, b), grid.index(a, b + 1), 0.8);
        add(grid.index(a, b), grid.index(a, b), 0);
      }
    const model::Polygons polygons = TrimmedSurface(grid, mesh).at(x);
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_LE((polygons.vertices[k].transpose() - expected[k]).norm(), rounding) << k;
  }
}

/// A hem lies beyond its edges, by a two hundredth of the cells of this scene.
TEST(TrimmedSurface, ReachesToCurvedSides) {
  const Grid grid = model::load_scene("skirt").sheet.grid;
  TriangleMesh mesh{.name = "hem", .vertices = {}, .triangles = {}};
  for (int k = 0; k <= 1000; ++k)
    mesh.vertices.emplace_back(-0.6 * std::cos(M_PI * k / 1000), -0.6 * std::sin(M_PI * k / 1000), 0);
  const model::Polygons polygons = TrimmedSurface(grid, mesh).at(grid.parameters());
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k)
    EXPECT_LE((polygons.vertices[k] - mesh.vertices[k]).norm(), rounding) << k;
}

std::string message(const std::function<void()>& f) {
  try {
    f();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(TrimmedSurface, HasItsVerticesOnTheGridAndInItsPlane) {
  const Grid grid = five_by_four();
  const auto refusal = [&](const Vector3d& vertex) {
    return message([&] { TrimmedSurface(grid, {.name = "a.obj", .vertices = {{0.5, 0.5, 0}, vertex}, .triangles = {}}); });
  };
  EXPECT_EQ(refusal({1, 0.6, 0}), "");
  EXPECT_EQ(refusal({1.02, 0.3, 0}), "") << "a twelfth of a cell";
  EXPECT_EQ(refusal({1.03, 0.3, 0}),
            "a.obj: vertex 2 at [1.03, 0.3, 0]: expected vertices on the grid, in metres times trim.scale");
  EXPECT_EQ(refusal({0.5, 0.3, 0.01}), "a.obj: vertex 2 at [0.5, 0.3, 0.01]: expected a flat mesh, with z = 0");
  EXPECT_THAT(refusal({std::nan(""), 0.3, 0}), testing::HasSubstr("expected vertices on the grid"));
}

TEST(TrimmedSurface, ComesFromTheFileOfAScene) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "disc.obj";
  write_mesh(file, {.name = "", .vertices = {{0, 0, 0}, {50, 0, 0}, {0, 50, 0}}, .triangles = {{0, 1, 2}}});
  const std::string lines = "name = 'x'\ngrid = { n = 5, size = 0.5 }\ntrim.file = 'disc.obj'\n",
                    origin = folder.path() / "a.toml";
  const Scene scene = model::parse_scene(lines + "trim.scale = 0.01\n", origin);
  EXPECT_EQ(scene.trim.file, file);
  const auto surface = model::trimmed_surface(scene);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->at(scene.sheet.grid.parameters()).vertices.size(), 3u);
  EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "b.toml")), to_toml(scene));
  EXPECT_FALSE(model::trimmed_surface(model::parse_scene("name = 'x'", origin)));
  EXPECT_EQ(message([&] { model::parse_scene(lines, origin); }),
            origin + ": trim: " + file.string() +
                ": vertex 2 at [50, 0, 0]: expected vertices on the grid, in metres times trim.scale");
  EXPECT_THAT(message([&] { model::parse_scene("name = 'x'\ntrim.file = 'no.obj'", origin); }),
              testing::HasSubstr(":2: trim.file = 'no.obj': expected the file of a mesh, "));
}

/// Panels without a mesh are drawn as they are; the particles are those of all panels.
TEST(TrimmedSurface, RidesOnEveryPanel) {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "part.obj",
             {.name = "", .vertices = {{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}}, .triangles = {{0, 1, 2}}});
  const std::string origin = folder.path() / "a.toml", panels = R"(
name = "two"
[grid]
n = [3, 3]
size = 0.5
[[panels]]
name = "front"
trim.file = "part.obj"
start.position = [0, 0, 1]
[[panels]]
name = "back"
start.position = [0, 0, 2]
)";
  const Scene scene = model::parse_scene(panels, origin);
  EXPECT_TRUE(scene.trim.file.empty());
  const auto surface = model::trimmed_surface(scene);
  ASSERT_TRUE(surface);
  const model::Garment garment(scene);
  const model::Polygons polygons = surface->at(garment.spread(garment.start().x));
  ASSERT_EQ(polygons.vertices.size(), 3u + 9);
  EXPECT_LE((polygons.vertices[1] - Vector3d(0.25, 0, 1)).norm(), rounding);
  EXPECT_LE((polygons.vertices[3 + 4] - Vector3d(0.25, 0.25, 2)).norm(), rounding);
  ASSERT_EQ(polygons.faces.size(), 1u + 4);
  EXPECT_THAT(polygons.faces[0], testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(polygons.faces[1], testing::ElementsAre(3, 4, 7, 6));
  EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "b.toml")), to_toml(scene));
  EXPECT_FALSE(model::trimmed_surface(model::without_trim(scene)));
  EXPECT_EQ(message([&] { model::parse_scene(panels + "trim.scale = 9\ntrim.file = 'part.obj'\n", origin); }),
            origin + ": trim: panel 'back': " + (folder.path() / "part.obj").string() +
                ": vertex 2 at [2.25, 0, 0]: expected vertices on the grid, in metres times trim.scale");
  EXPECT_EQ(message([&] { model::parse_scene(panels + "trim.outline = true\ntrim.file = 'part.obj'\n", origin); }),
            origin + ": trim: panel 'back': expected a file or an outline, not both");
}

/// The area of its triangles, which all go round counterclockwise [m²].
double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const double own = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).z() / 2;
    EXPECT_GT(own, 0);
    sum += own;
  }
  return sum;
}

/// Edges that belong to one triangle.
std::map<std::pair<int, int>, int> border(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const std::array<int, 3>& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++uses[std::minmax(triangle[k], triangle[(k + 1) % 3])];
  std::erase_if(uses, [](const auto& edge) { return edge.second != 1; });
  return uses;
}

TEST(OutlineMesh, FillsRectanglesAndFourSides) {
  EXPECT_NEAR(area(model::outline_mesh(five_by_four())), five_by_four().size_u * five_by_four().size_v, rounding);
  const Grid skirt = model::load_scene("skirt").sheet.grid;
  const TriangleMesh mesh = model::outline_mesh(skirt);
  EXPECT_NEAR(area(mesh), M_PI / 2 * (0.6 * 0.6 - 0.12 * 0.12), 2e-4);
  EXPECT_LE(area(mesh), M_PI / 2 * (0.6 * 0.6 - 0.12 * 0.12));
  const double cells = (skirt.nu - 1) * (skirt.nv - 1);
  EXPECT_GT(static_cast<double>(mesh.triangles.size()), cells);
  EXPECT_LT(static_cast<double>(mesh.triangles.size()), 5 * cells);
  int on_hem = 0;
  for (const auto& [ends, uses] : border(mesh)) {
    const Vector3d& end = mesh.vertices[ends.first];
    on_hem += std::abs(end.norm() - 0.6) < rounding;
  }
  EXPECT_GE(on_hem, 2 * (skirt.nu - 1));
  EXPECT_NO_THROW(TrimmedSurface(skirt, mesh));
}

/// Where pieces of a side meet between particles, lines of the grid cut the corner off; the mesh does not.
TEST(OutlineMesh, KeepsCornersBetweenParticles) {
  const Scene scene = model::load_scene("sewn_dress", std::vector<model::Override>{{"trim.outline", "true"}});
  const auto surface = model::trimmed_surface(scene);
  ASSERT_TRUE(surface);
  const Grid& front = scene.panels.front().grid;
  Vectors pattern(2 * front.particles(), 3);
  pattern << front.parameters(), front.parameters();
  const std::vector<Vector3d> vertices = surface->at(pattern).vertices;
  const auto distance = [](const Vector3d& vertex) { return (vertex - Vector3d(0.085, 1.04, 0)).norm(); };
  EXPECT_LE(distance(std::ranges::min(vertices, {}, distance)), 1e-12);
  EXPECT_GT(distance(pattern.row(front.index(20, front.nv - 1))), 1e-3);
}

/// Cells on a cut are drawn whole, and the mesh ends on the circle.
TEST(OutlineMesh, KeepsTheCurveOfACut) {
  const Grid grid = model::load_scene("cusick").sheet.grid;
  const TriangleMesh mesh = model::outline_mesh(grid);
  EXPECT_NEAR(area(mesh), M_PI * 0.15 * 0.15, 2e-4);
  const Vector3d centre(0.15, 0.15, 0);
  for (const auto& [ends, uses] : border(mesh)) {
    const double r = (mesh.vertices[ends.first] - centre).norm();
    EXPECT_LE(r, 0.15 + rounding);
    EXPECT_GE(r, 0.15 - 1e-4);
  }
  EXPECT_NO_THROW(TrimmedSurface(grid, mesh));
}

/// Sewn borders have as many cells, so that meshes on both sides of a seam meet there.
TEST(OutlineMesh, HasTheParticlesOfTheBorder) {
  const Scene scene = model::load_scene("t_shirt", std::vector<model::Override>{{"trim.outline", "true"}});
  for (const model::PanelRule& panel : scene.panels) {
    EXPECT_TRUE(panel.trim.outline);
    const TriangleMesh mesh = model::outline_mesh(panel.grid);
    const Vectors pattern = panel.grid.parameters();
    for (int b = 0; b < panel.grid.nv; ++b)
      for (int a = 0; a < panel.grid.nu; ++a) {
        if (a > 0 && b > 0 && a + 1 < panel.grid.nu && b + 1 < panel.grid.nv) continue;
        const Vector3d particle = pattern.row(panel.grid.index(a, b));
        const auto distance = [&](const Vector3d& vertex) { return (vertex - particle).norm(); };
        EXPECT_LE(distance(std::ranges::min(mesh.vertices, {}, distance)), 1e-9) << panel.name << " " << a << " " << b;
      }
  }
}

}  // namespace
}  // namespace drape::verify::trimmed_surface_test
