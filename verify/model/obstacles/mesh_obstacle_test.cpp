// Obstacles from mesh files: their distances against exact ones and against all triangles, and which files are refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model/obstacles/mesh_shape.hpp"
#include "model/obstacles/obstacle.hpp"
#include "verify/support/distance_field.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/obstacles.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::mesh_obstacle_test {
namespace {

using Eigen::Vector3d;
using model::Corners;
using model::Nearest;
using model::Obstacle;
using model::TriangleMesh;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Obstacle read(const std::string& file, double scale = 1) {
  return Obstacle(verify::obstacle(fmt::format("shape = 'mesh', file = '{}', scale = {}", file, scale)));
}

/// The mesh as it comes back from a file.
Obstacle obstacle(const TriangleMesh& mesh) {
  const base::TemporaryFolder folder;
  write_mesh(folder / "mesh.ply", mesh);
  return read(folder / "mesh.ply");
}

// --- A box, from each format -------------------------------------------------------------------------------------------------

void expect_box(const Obstacle& mesh, const Vector3d& size) {
  const Obstacle box(verify::obstacle(fmt::format("shape = 'box', size = [{}, {}, {}]", size[0], size[1], size[2])));
  for (const Vector3d& p : random_points(300, size.maxCoeff(), 11)) {
    EXPECT_NEAR(mesh.nearest(p).distance, box.nearest(p).distance, 1e-12);
    EXPECT_LE((mesh.nearest(p).normal - box.nearest(p).normal).norm(), 1e-12);
  }
}

class MeshFormat : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, MeshFormat, testing::Values("obj", "ply", "stl", "gltf", "glb"),
                         [](const auto& test) { return test.param; });

TEST_P(MeshFormat, GivesTheExactBox) {
  const base::TemporaryFolder folder;
  write_mesh(folder / ("box." + GetParam()), box_mesh({2, 4, 6}));
  expect_box(read(folder / ("box." + GetParam())), {2, 4, 6});
  expect_box(read(folder / ("box." + GetParam()), 0.25), {0.5, 1, 1.5});
}

TEST_P(MeshFormat, MayBeInsideOut) {
  const base::TemporaryFolder folder;
  TriangleMesh mesh = box_mesh({2, 4, 6});
  for (std::array<int, 3>& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  write_mesh(folder / ("box." + GetParam()), mesh);
  expect_box(read(folder / ("box." + GetParam())), {2, 4, 6});
}

TEST(Mesh, MayHavePolygonsPointsAndNormals) {
  const base::TemporaryFolder folder;
  std::ofstream(folder / "box.obj") << "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
                                       "vn 1 0 0\nvn -1 0 0\nvn 0 1 0\nvn 0 -1 0\nvn 0 0 1\nvn 0 0 -1\np 1\n"
                                       "f 2//1 4//1 8//1 6//1\nf 1//2 5//2 7//2 3//2\nf 3//3 7//3 8//3 4//3\n"
                                       "f 1//4 2//4 6//4 5//4\nf 5//5 6//5 8//5 7//5\nf 1//6 3//6 4//6 2//6\n";
  expect_box(read(folder / "box.obj"), {2, 2, 2});
}

TEST(Mesh, HasNormalsOnItsSurface) {
  const Obstacle mesh = obstacle(box_mesh({2, 2, 2}));
  const auto expect = [&](const Vector3d& p, const Vector3d& normal) {
    const auto [distance, n] = mesh.nearest(p);
    EXPECT_LE(std::abs(distance), 1e-15);
    EXPECT_LE((n - normal.normalized()).norm(), 1e-15);
  };
  expect({1, 0.5, -0.25}, {1, 0, 0});
  expect({1, 0.25, 0.25}, {1, 0, 0});  // on the diagonal, an edge between equal faces
  expect({-1, 0.5, -1}, {-1, 0, -1});
  expect({1, -1, 1}, {1, -1, 1});
  for (const double nudge : {1e-17, 1e-16, -1e-16}) EXPECT_NEAR(mesh.nearest({1 + nudge, -1, 1}).normal.norm(), 1, 1e-15);
}

// --- Against all triangles ---------------------------------------------------------------------------------------------------

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  return (a + std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.) * (b - a) - p).norm();
}

double distance_to_triangle(const Vector3d& p, const Corners& c) {
  Eigen::Matrix<double, 3, 2> sides;
  sides << c[1] - c[0], c[2] - c[0];
  const Eigen::Vector2d weights = sides.colPivHouseholderQr().solve(p - c[0]);
  if (weights.minCoeff() >= 0 && weights.sum() <= 1) return (c[0] + sides * weights - p).norm();
  return std::min({distance_to_segment(p, c[0], c[1]), distance_to_segment(p, c[1], c[2]), distance_to_segment(p, c[2], c[0])});
}

/// Solid angle of a triangle seen from p [van Oosterom, Strackee 1983].
double solid_angle(const Vector3d& p, const Corners& corners) {
  const Vector3d a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
  return 2 * std::atan2(a.dot(b.cross(c)),
                        a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() + c.dot(a) * b.norm());
}

/// Signed by how much of the full sphere the mesh covers: without normals.
double brute_distance(const Vector3d& p, const TriangleMesh& mesh) {
  double distance = std::numeric_limits<double>::infinity(), angle = 0;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    const Corners c = corners(mesh, triangle);
    distance = std::min(distance, distance_to_triangle(p, c));
    angle += solid_angle(p, c);
  }
  return angle > 2 * M_PI ? -distance : distance;
}

TEST(Mesh, HasTheLeastDistanceOfItsTriangles) {
  for (const double radius : {1., 0.6, 2.5}) {
    const TriangleMesh mesh = spiky_mesh(radius);
    const Obstacle quick = obstacle(mesh);
    int inside = 0;
    for (const Vector3d& p : random_points(400, 1.25 * std::max(1., radius), 11)) {
      const double distance = brute_distance(p, mesh);
      EXPECT_NEAR(quick.nearest(p).distance, distance, 1e-14);
      inside += distance < 0;
    }
    EXPECT_GT(inside, 20);
  }
}

TEST(Mesh, GrowsAlongTheNormalFromTheNearestPoint) {
  for (const TriangleMesh& mesh : {box_mesh({1, 2, 1.5}), spiky_mesh(1), spiky_mesh(0.6)}) {
    const Obstacle quick = obstacle(mesh);
    expect_distance_field([&](const Vector3d& p) { return quick.nearest(p); }, 2);
  }
}

TEST(Mesh, MayBeFarFromItsOrigin) {
  TriangleMesh mesh = box_mesh({2, 2, 2});
  for (Vector3d& v : mesh.vertices) v += Vector3d(1024, 0, 0);
  EXPECT_NEAR(obstacle(mesh).nearest({1024, 0, 3}).distance, 2, 1e-12);
  EXPECT_NEAR(obstacle(mesh).nearest({1024.5, 0, 0}).distance, -0.5, 1e-12);
}

// --- Files that are refused --------------------------------------------------------------------------------------------------

std::string refusal(const std::string& file) {
  try {
    model::mesh_shape(file, 1);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

/// What the reader says of a mesh, without the name of the file.
std::string refusal(const TriangleMesh& mesh) {
  const base::TemporaryFolder folder;
  const std::string file = folder / "mesh.ply";
  write_mesh(file, mesh);
  const std::string said = refusal(file);
  EXPECT_THAT(said, StartsWith(file + ": "));
  return said.substr(std::min(said.size(), file.size() + 2));
}

std::string refusal_of_text(const std::string& name, const std::string& text) {
  const base::TemporaryFolder folder;
  std::ofstream(folder / name) << text;
  return refusal(folder / name);
}

TEST(RefusedMesh, CannotBeRead) {
  EXPECT_THAT(refusal("no/such.obj"), StartsWith("no/such.obj: cannot be read: expected a mesh"));
  EXPECT_THAT(refusal_of_text("text.ply", "no mesh\n"), HasSubstr("text.ply: cannot be read: expected a mesh"));
  EXPECT_THAT(refusal_of_text("mesh.unknown", "v 0 0 0\n"), HasSubstr("mesh.unknown: cannot be read: expected a mesh"));
}

TEST(RefusedMesh, HasNoTriangles) {
  EXPECT_THAT(refusal_of_text("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), HasSubstr("line.obj: expected a mesh with triangles"));
}

TEST(RefusedMesh, IsNotFinite) {
  const std::string rest = "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  EXPECT_EQ(refusal_of_text("mesh.obj", "v 0 0 0\n" + rest), "");
  EXPECT_THAT(refusal_of_text("mesh.obj", "v nan 0 0\n" + rest), HasSubstr("mesh.obj: expected finite coordinates"));
  EXPECT_THAT(refusal_of_text("mesh.obj", "v 0 inf 0\n" + rest), HasSubstr("mesh.obj: expected finite coordinates"));
}

TEST(RefusedMesh, IsOpen) {
  TriangleMesh mesh = box_mesh({1, 1, 1});
  mesh.triangles.pop_back();
  EXPECT_EQ(refusal(mesh), "expected a closed mesh, 3 edges of its 11 triangles are open");
}

TEST(RefusedMesh, BranchesAtAnEdge) {
  TriangleMesh mesh = box_mesh({2, 2, 2});
  const TriangleMesh other = box_mesh({2, 2, 2});
  for (const Vector3d& v : other.vertices) mesh.vertices.emplace_back(v + Vector3d(2, 2, 0));
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + 8, b + 8, c + 8});
  EXPECT_EQ(refusal(mesh), "expected edges of two triangles each, 1 have more");
}

TEST(RefusedMesh, IsTwisted) {
  TriangleMesh mesh = box_mesh({1, 1, 1});
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_EQ(refusal(mesh), "expected triangles that agree on which side is outside, across 3 edges they do not");
}

TEST(RefusedMesh, HasATriangleWithoutArea) {
  const TriangleMesh mesh{"",
                          {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}},
                          {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 4}, {0, 4, 3}, {2, 3, 4}}};
  EXPECT_EQ(refusal(mesh), "expected triangles with an area, the one at (0, 0, 0) has none");
}

TEST(RefusedMesh, EnclosesNothing) {
  const TriangleMesh mesh{"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_EQ(refusal(mesh), "expected a mesh that encloses a volume");
}

}  // namespace
}  // namespace drape::verify::mesh_obstacle_test
