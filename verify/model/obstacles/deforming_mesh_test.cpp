// Meshes that deform: vertices at key times, from files or from an animation, against rigid meshes that move in the same way
// and against closed forms; contacts with them; which files are refused.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/report/base64.hpp"
#include "model/obstacles/contacts.hpp"
#include "model/obstacles/mesh_file.hpp"
#include "model/obstacles/obstacle.hpp"
#include "model/obstacles/posed_mesh.hpp"
#include "model/obstacles/surface.hpp"
#include "model/obstacles/triangle_hierarchy.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/contact_scenes.hpp"
#include "verify/support/distance_field.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/obstacles.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::deforming_mesh_test {
namespace {

using Eigen::Vector3d;
using model::MaterialPoint;
using model::Obstacle;
using model::ObstacleRule;
using model::PosedMesh;
using model::TriangleMesh;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

template <class Move>
TriangleMesh moved(TriangleMesh mesh, const Move& move) {
  for (Vector3d& v : mesh.vertices) v = move(v);
  return mesh;
}

/// Meshes at times as files "0.ply", "1.ply", … of a folder.
class Frames {
 public:
  explicit Frames(const std::vector<std::pair<double, TriangleMesh>>& meshes) {
    std::vector<std::string> frames;
    for (const auto& [t, mesh] : meshes) {
      const std::string file = folder_ / fmt::format("{}.ply", frames.size());
      write_mesh(file, mesh);
      frames.push_back(fmt::format("{{ time = {}, file = '{}' }}", t, file));
    }
    keys_ = fmt::format("shape = 'mesh', file = '{}', frames = [{}]", first(), fmt::join(frames, ", "));
  }

  std::string first() const { return folder_ / "0.ply"; }

  /// The entries of an obstacle.
  const std::string& keys() const { return keys_; }

  /// At rest, the first mesh.
  std::string rigid() const { return fmt::format("shape = 'mesh', file = '{}'", first()); }

 private:
  base::TemporaryFolder folder_;
  std::string keys_;
};

/// The surface of an obstacle at a time.
PosedMesh posed(const Obstacle& obstacle, double t) {
  PosedMesh mesh = *obstacle.deforming();
  mesh.set_time(t);
  return mesh;
}

// --- Moved by its vertices as by key frames ----------------------------------------------------------------------------------

const Vector3d shift(0.5, -0.25, 0.75);

/// A sphere that goes by `shift` from t = 0.5 s to 1.5 s.
class Shifted : public testing::Test {
 protected:
  Frames frames_{{{0.5, spiky_mesh(1)}, {1.5, moved(spiky_mesh(1), [](const Vector3d& v) -> Vector3d { return v + shift; })}}};
  ObstacleRule by_vertices_ = obstacle(frames_.keys() + ", friction = 0.4");
  ObstacleRule by_motion_ = obstacle(frames_.rigid() +
                                     ", friction = 0.4, motion = [{ time = 0.5 }, { time = 1.5, position = "
                                     "[0.5, -0.25, 0.75] }]");
};

TEST_F(Shifted, HasTheDistancesOfTheRigidMesh) {
  const Obstacle vertices(by_vertices_), motion(by_motion_);
  EXPECT_EQ(motion.deforming(), nullptr);
  ASSERT_NE(vertices.deforming(), nullptr);
  for (const double t : {-1.0, 0.5, 0.8, 1.1, 1.5, 7.0}) {
    const PosedMesh mesh = posed(vertices, t);
    const Vector3d velocity = t >= 0.5 && t < 1.5 ? shift : Vector3d(0, 0, 0);
    for (const Vector3d& p : random_points(100, 2, 5)) {
      const auto expected = motion.nearest(motion.pose(t).to_body(p));
      const auto [nearest, at] = mesh.touch(p);
      EXPECT_NEAR(nearest.distance, expected.distance, 4e-15);
      EXPECT_LE((nearest.normal - expected.normal).norm(), 1e-13);
      EXPECT_LE((mesh.velocity(at) - velocity).norm(), 1e-15) << t;
      EXPECT_LE((mesh.pose(at).position - (p - nearest.distance * nearest.normal)).norm(), 1e-14);
    }
  }
}

model::Contacts contacts_of(const ObstacleRule& rule, int particles, solver::Counters& work) {
  return {std::vector{rule}, {.distance = 0.01}, {0, 0, -9.81}, particles, work};
}

void expect_same(const std::vector<solver::Contact>& one, const std::vector<solver::Contact>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].particle, other[k].particle);
    EXPECT_LE((one[k].normal - other[k].normal).norm(), 1e-12);
    EXPECT_NEAR(one[k].gap, other[k].gap, 1e-14);
    EXPECT_NEAR(one[k].least, other[k].least, 1e-12);
    EXPECT_LE((one[k].velocity - other[k].velocity).norm(), 1e-12);
    EXPECT_EQ(one[k].friction, other[k].friction);
  }
}

TEST_F(Shifted, HasTheContactsOfTheRigidMesh) {
  const std::vector<Vector3d> points = random_points(200, 1.3, 5);
  solver::State y{solver::Vectors(200, 3), solver::Vectors::Constant(200, 3, 0.7)};
  for (int i = 0; i < 200; ++i) y.x.row(i) = points[i];
  solver::Counters work, other_work;
  model::Contacts vertices = contacts_of(by_vertices_, 200, work), motion = contacts_of(by_motion_, 200, other_work);
  std::size_t most = 0;
  for (const auto& [t, h] : {std::pair(0.1, 0.05), {0.5, 0.05}, {0.55, 0.05}, {0.55, 0.025}, {1.3, 0.1}, {0.5, 0.1}}) {
    std::vector<solver::Contact> found, expected;
    vertices.find(t, h, y, found);
    motion.find(t, h, y, expected);
    expect_same(found, expected);
    most = std::max(most, found.size());
    std::vector<model::Depth> inside, expected_inside;
    vertices.near(t, y.x, 0.01, inside);
    motion.near(t, y.x, 0.01, expected_inside);
    ASSERT_EQ(inside.size(), expected_inside.size());
    for (std::size_t k = 0; k < inside.size(); ++k) {
      EXPECT_NEAR(inside[k].depth, expected_inside[k].depth, 1e-14);
      EXPECT_LE((inside[k].velocity - expected_inside[k].velocity).norm(), 1e-9);
    }
    EXPECT_LE((vertices.distances(t, y.x) - motion.distances(t, y.x)).cwiseAbs().maxCoeff(), 1e-14);
  }
  EXPECT_GT(most, 60U);
}

TEST_F(Shifted, MovesParticlesAsTheRigidMesh) {
  const auto scene = [](const std::string& keys) {
    return contact_scenes::particles(
        fmt::format("obstacles = [{{ {}, scale = 0.1, position = [0.04, 0.06, -0.12] }}]\n"
                    "end.time = 1\n",
                    keys));
  };
  const auto by_motion = contact_scenes::particles(
      fmt::format("obstacles = [{{ {}, scale = 0.1, motion = [{{ time = 0.5, position = [0.04, 0.06, -0.12] }}, "
                  "{{ time = 1.5, position = [0.09, 0.035, -0.045] }}] }}]\nend.time = 1\n",
                  frames_.rigid() + ", friction = 0.4"));
  const auto by_vertices = scene(frames_.keys() + ", friction = 0.4");
  for (const std::string method : {"bdf2", "verlet", "imex-euler"}) {
    const auto one = run(by_vertices, method, 0.01), other = run(by_motion, method, 0.01);
    double constrained = 0;
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_LE((one[k].y.x - other[k].y.x).cwiseAbs().maxCoeff(), 1e-12) << method << " " << one[k].t;
      constrained += one[k].contacts.constrained;
    }
    EXPECT_GT(constrained, 0) << method;
  }
}

/// A sphere that turns by 9 degrees about z within a step. Files have single precision.
TEST(Turned, HasTheContactsOfTheRigidMesh) {
  constexpr double degrees = 9, h = 0.1;
  const Eigen::AngleAxisd turn(degrees * M_PI / 180, Vector3d::UnitZ());
  const TriangleMesh mesh = spiky_mesh(0.75);
  const Frames frames({{0, mesh}, {h, moved(mesh, [&](const Vector3d& v) -> Vector3d { return turn * v; })}});
  solver::Counters work, other_work;
  model::Contacts vertices = contacts_of(obstacle(frames.keys()), 200, work);
  model::Contacts motion = contacts_of(
      obstacle(frames.rigid() + ", motion = [{ time = 0 }, { time = 0.1, rotation = [0, 0, 9] }]"), 200, other_work);
  const std::vector<Vector3d> points = random_points(200, 1, 5);
  solver::State y{solver::Vectors(200, 3), solver::Vectors::Zero(200, 3)};
  for (int i = 0; i < 200; ++i) y.x.row(i) = points[i];
  std::vector<solver::Contact> found, expected;
  vertices.find(0, h, y, found);
  motion.find(0, h, y, expected);
  int both = 0, same = 0;
  for (const solver::Contact& one : expected) {
    const auto other = std::ranges::find(found, one.particle, &solver::Contact::particle);
    if (other == found.end()) continue;  // beyond the mesh a rigid motion takes it farther, so more are watched
    ++both;
    // Near places that are as far from two triangles, round-off decides.
    same += (one.normal - other->normal).norm() < 2e-6 && std::abs(one.least - other->least) < 1e-6 &&
            (one.velocity - other->velocity).norm() < 2e-5;
  }
  EXPECT_GT(both, 50);
  EXPECT_GE(same, both - 2);
}

// --- A mesh that pulsates ----------------------------------------------------------------------------------------------------

/// A mesh that grows from t = 0 to 2 s by half of its size.
class Pulsating : public testing::Test {
 protected:
  static double size(double t) { return 1 + 0.25 * t; }

  TriangleMesh mesh_ = spiky_mesh(0.75);
  Frames frames_{{{0, mesh_}, {2, moved(mesh_, [](const Vector3d& v) -> Vector3d { return 1.5 * v; })}}};
  Obstacle growing_{obstacle(frames_.keys())};
};

TEST_F(Pulsating, HasTheDistancesOfTheScaledMesh) {
  for (const double t : {0.0, 0.3, 1.7, 2.0}) {
    const Obstacle scaled(obstacle(fmt::format("{}, scale = {}", frames_.rigid(), size(t))));
    const PosedMesh mesh = posed(growing_, t);
    int inside = 0;
    for (const Vector3d& p : random_points(200, 1.8, 5)) {
      const auto [distance, normal] = mesh.nearest(p);
      EXPECT_NEAR(distance, scaled.nearest(p).distance, 4e-15);
      EXPECT_LE((normal - scaled.nearest(p).normal).norm(), 1e-13);
      inside += distance < 0;
    }
    EXPECT_GT(inside, 10);
  }
}

TEST_F(Pulsating, HasTheVelocityOfItsSurface) {
  for (const double t : {0.0, 0.3, 1.7}) {
    const PosedMesh mesh = posed(growing_, t);
    for (const Vector3d& p : random_points(200, 1.8, 5)) {
      const auto [nearest, at] = mesh.touch(p);
      const Vector3d surface = p - nearest.distance * nearest.normal;
      EXPECT_NEAR(at.weights.sum(), 1, 1e-15);
      EXPECT_GE(at.weights.minCoeff(), -1e-14);
      EXPECT_LE((mesh.pose(at).position - surface).norm(), 1e-14);
      EXPECT_LE((mesh.velocity(at) - 0.25 / size(t) * surface).norm(), 1e-14);
    }
  }
}

/// The half-spaces of contacts are behind the surface at the end of a step, and move with the material, also of a mesh that
/// turns as a whole.
TEST_F(Pulsating, HasContactsThatMoveWithItsMaterial) {
  const ObstacleRule turning =
      obstacle(frames_.keys() + ", motion = [{ time = 0 }, { time = 2, position = [0, 0, 1], rotation = [0, 0, 90] }]");
  const double t = 0.4, h = 0.02, d = 0.01;
  solver::State y{solver::Vectors(200, 3), solver::Vectors::Zero(200, 3)};
  const std::vector<Vector3d> points = random_points(200, 1.1, 5);
  for (int i = 0; i < 200; ++i) y.x.row(i) = points[i] + Vector3d(0, 0, 0.2);
  solver::Counters work;
  model::Contacts contacts = contacts_of(turning, 200, work);
  std::vector<solver::Contact> found;
  contacts.find(t, h, y, found);
  const Obstacle whole(turning);
  const model::Pose begin = whole.pose(t), end = whole.pose(t + h);
  const PosedMesh before = posed(whole, t), after = posed(whole, t + h);
  int faces = 0;
  for (const solver::Contact& c : found) {
    const Vector3d p = begin.to_body(y.x.row(c.particle));
    const auto [nearest, at] = before.touch(p);
    EXPECT_NEAR(c.gap, nearest.distance - d, 1e-14);
    if (at.weights.minCoeff() < 0.05) continue;  // the nearest triangle at the end may be another
    ++faces;
    // Homothetic triangles are parallel: the nearest point stays the same.
    EXPECT_LE((c.normal - end.rotation * nearest.normal).norm(), 1e-13);
    const Vector3d border = after.pose(at).position + d * nearest.normal, start = before.pose(at).position + d * nearest.normal;
    EXPECT_NEAR(c.least, end.to_world(border).dot(c.normal) + 0.5 * std::min(0.0, c.gap), 1e-13);
    EXPECT_LE((c.velocity - (end.to_world(border) - begin.to_world(start)) / h).norm(), 1e-11);
  }
  EXPECT_GT(faces, 20);
}

TEST_F(Pulsating, MovesWhatIsInsideByBoth) {
  const ObstacleRule turning = obstacle(frames_.keys() + ", motion = [{ time = 0 }, { time = 2, rotation = [0, 0, 90] }]");
  solver::Counters work;
  model::Contacts contacts = contacts_of(turning, 1, work);
  std::vector<model::Depth> found;
  const double t = 0.4, turned = t * M_PI / 4;
  solver::Vectors x(1, 3);
  x << 0.5, 0.4, 0.1;
  contacts.near(t, x, 0.01, found);
  ASSERT_EQ(found.size(), 1U);
  const Vector3d surface = x.row(0).transpose() + (found[0].depth - 0.01) * found[0].normal;
  const Vector3d expected = 0.25 / size(t) * surface + M_PI / 4 * Vector3d::UnitZ().cross(surface);
  EXPECT_LE((found[0].velocity - expected).norm(), 1e-5) << turned;
}

/// No particle is left out that the surface reaches within a step, though it was far when it was asked last.
TEST_F(Pulsating, WatchesWhatItWillReach) {
  solver::Counters work;
  model::Contacts contacts = contacts_of(obstacle(frames_.keys()), 1, work);
  solver::State y{solver::Vectors(1, 3), solver::Vectors::Zero(1, 3)};
  y.x << 0, 0, 1.45;
  std::vector<solver::Contact> found;
  for (const double t : {0.0, 1e-3, 2e-3}) contacts.find(t, 1e-3, y, found);
  EXPECT_EQ(found.size(), 0U);
  EXPECT_EQ(work.count("obstacle_queries"), 1) << "far away it is not asked again";
  contacts.find(1.79, 0.01, y, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].velocity.z(), 0.25, 1e-3);
  found.clear();
  contacts.find(1e-3, 1e-3, y, found);
  EXPECT_EQ(found.size(), 0U) << "back in time";
  contacts.find(0, 2, y, found);
  EXPECT_EQ(found.size(), 1U) << "at the end of a long step";
}

TEST(Hierarchy, RefittedFindsWhatARebuiltOneFinds) {
  const TriangleMesh from = spiky_mesh(1), to = moved(spiky_mesh(0.5), [](const Vector3d&v) -> Vector3d {
                                             return {2 * v.x() + v.z() * v.z(), v.y(), 0.3 * v.z() - v.x()};
                                           });
  model::TriangleHierarchy refitted(from);
  refitted.refit(to);
  const model::TriangleHierarchy rebuilt(to);
  for (const Vector3d& p : random_points(500, 3, 5)) {
    double least = 1e9;
    for (const auto& triangle : to.triangles)
      least = std::min(least, (p - model::nearest_on_triangle(corners(to, triangle), p).point).norm());
    EXPECT_NEAR((p - refitted.nearest(p).nearest.point).norm(), least, 1e-15);
    EXPECT_NEAR((p - rebuilt.nearest(p).nearest.point).norm(), least, 1e-15);
  }
}

TEST(PosedMesh, IsADistanceFieldWhereItHasDeformed) {
  const auto shear = [](const Vector3d& v) -> Vector3d { return {v.z(), v.x() - v.z(), v.y()}; };
  const Frames frames({{0, spiky_mesh(0.75)}, {1, moved(spiky_mesh(0.75), shear)}});
  const PosedMesh mesh = posed(Obstacle(obstacle(frames.keys())), 0.875);
  expect_distance_field([&](const Vector3d& p) { return mesh.nearest(p); }, 2);
}

TEST(PosedMesh, PassesThroughItsKeyTimesAndGoesBack) {
  const Frames frames({{0, box_mesh({2, 2, 2})}, {1, box_mesh({4, 2, 2})}, {3, box_mesh({2, 2, 4})}});
  PosedMesh mesh = *Obstacle(obstacle(frames.keys())).deforming();
  const auto expect = [&](double t, double x, double z) {
    mesh.set_time(t);
    EXPECT_NEAR(mesh.nearest({9, 0, 0}).distance, 9 - x, 1e-14) << t;
    EXPECT_NEAR(mesh.nearest({0, 0, 9}).distance, 9 - z, 1e-14) << t;
  };
  expect(-1, 1, 1);
  expect(0.5, 1.5, 1);
  expect(1, 2, 1);
  expect(2, 1.5, 1.5);
  expect(5, 1, 2);
  expect(0.25, 1.25, 1);
  expect(0, 1, 1);
  EXPECT_DOUBLE_EQ(mesh.moving().way(0.5), 0.5);
  EXPECT_DOUBLE_EQ(mesh.moving().way(3), 1 + std::sqrt(2));
}

// --- Cloth on it -------------------------------------------------------------------------------------------------------------

/// A box whose top rises by 0.1 m from 0.1 s to 0.6 s, and which goes 0.1 m aside from 0.8 s to 1.3 s.
Frames piston() {
  const TriangleMesh low = box_mesh({0.25, 0.25, 0.0625});
  const auto risen = [](const Vector3d& v) -> Vector3d { return v + Vector3d(0, 0, v.z() > 0 ? 0.1 : 0); };
  const auto aside = [&](const Vector3d& v) -> Vector3d { return risen(v) + Vector3d(0.1, 0, 0); };
  return Frames({{0.1, low}, {0.6, moved(low, risen)}, {0.8, moved(low, risen)}, {1.3, moved(low, aside)}});
}

class PistonContact : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, PistonContact, testing::ValuesIn(contact_scenes::methods()), [](const auto& test) {
  std::string name = test.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(PistonContact, CarriesCloth) {
  const Frames frames = piston();
  const auto trial = contact_scenes::sheet(
      fmt::format("obstacles = [{{ {}, friction = 2, position = [0.15, 0.15, -0.04] }}]\nend.time = 1.3\n", frames.keys()));
  const auto moments = run(trial, GetParam(), 0.005);
  EXPECT_GE(contact_scenes::clearance(trial, moments), 5e-3 - 1e-6);
  const auto& end = moments.back();
  const int middle = 24;  // of 7 × 7
  EXPECT_NEAR(end.y.x(middle, 2), -0.04 + 0.03125 + 0.1 + 5e-3, 1e-3);
  EXPECT_NEAR(end.y.x(middle, 0), 0.25, 5e-3);
  const auto rising = std::ranges::find_if(moments, [](const auto& moment) { return moment.t > 0.5; });
  EXPECT_NEAR(rising->y.v(middle, 2), 0.2, 0.02);
}

// --- An animation ------------------------------------------------------------------------------------------------------------

/// A tube of four sides and two caps with vertices of their own, which two joints bend: the second, at z = 1, turns about x by
/// 60 degrees in a second. Its skin lies below a node that glTF ignores.
class Tube {
 public:
  static constexpr int rings = 5;
  static constexpr double degrees = 60;

  Tube() {
    const auto ring = [&](int k) {
      for (int side = 0; side < 4; ++side) {
        const double x = side == 0 || side == 3 ? -0.25 : 0.25, y = side < 2 ? -0.25 : 0.25;
        vertices.emplace_back(x, y, 0.5 * k);
        bent.push_back(0.25 * k);
      }
    };
    for (int k = 0; k < rings; ++k) ring(k);
    for (int k = 0; k + 1 < rings; ++k)
      for (int side = 0; side < 4; ++side) {
        const int a = 4 * k + side, b = 4 * k + (side + 1) % 4;
        triangles.insert(triangles.end(), {a, b, b + 4, a, b + 4, a + 4});
      }
    const int caps = 4 * rings;
    ring(0), ring(rings - 1);
    for (const int corner : {0, 2, 1, 0, 3, 2}) triangles.push_back(caps + corner);
    for (const int corner : {4, 5, 6, 4, 6, 7}) triangles.push_back(caps + corner);
  }

  /// Where linear blend skinning takes a vertex at a time.
  Vector3d skinned(int v, double t) const {
    const Vector3d joint(0, 0, 1), p = vertices[v];
    const Eigen::AngleAxisd turn(t * degrees * M_PI / 180, Vector3d::UnitX());
    return root + (1 - bent[v]) * p + bent[v] * (joint + turn * (p - joint));
  }

  /// As glTF; `channels` and `morph` are what its animation "bend" has.
  std::string gltf(const std::string& more_animations = "") const {
    std::string bytes;
    for (const Vector3d& v : vertices) append(bytes, v);
    const std::size_t joints = bytes.size();
    for (std::size_t v = 0; v < vertices.size(); ++v) bytes += std::string("\0\1\0\0", 4);
    const std::size_t weights = bytes.size();
    for (const double part : bent)
      for (const double weight : {1 - part, part, 0.0, 0.0}) append(bytes, weight);
    const std::size_t inverse = bytes.size();
    for (const double z : {0.0, -1.0})
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) append(bytes, row == column ? 1.0 : column == 3 && row == 2 ? z : 0.0);
    const std::size_t times = bytes.size();
    for (const double t : {0.0, 1.0}) append(bytes, t);
    const std::size_t turns = bytes.size();
    for (const double angle : {0.0, degrees * M_PI / 360})
      for (const double q : {std::sin(angle), 0.0, 0.0, std::cos(angle)}) append(bytes, q);
    const std::size_t indices = bytes.size();
    for (const int corner : triangles) bytes.append(reinterpret_cast<const char*>(&corner), sizeof corner);

    std::vector<std::string> views, accessors;
    const auto view = [&](std::size_t begin, std::size_t end, int component, const std::string& type, std::size_t count) {
      views.push_back(fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", begin, end - begin));
      accessors.push_back(fmt::format(R"({{"bufferView": {}, "componentType": {}, "count": {}, "type": "{}"}})",
                                      accessors.size(), component, count, type));
    };
    constexpr int single = 5126, byte = 5121, whole = 5125;
    view(0, joints, single, "VEC3", vertices.size());
    view(joints, weights, byte, "VEC4", vertices.size());
    view(weights, inverse, single, "VEC4", vertices.size());
    view(inverse, times, single, "MAT4", 2);
    view(times, turns, single, "SCALAR", 2);
    view(turns, indices, single, "VEC4", 2);
    view(indices, bytes.size(), whole, "SCALAR", triangles.size());
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
"nodes": [{{"mesh": 0, "skin": 0, "translation": [{}, 0, 0]}},
          {{"name": "root", "translation": [{}, {}, {}], "children": [2]}},
          {{"name": "lower", "children": [3]}}, {{"name": "upper", "translation": [0, 0, 1]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}, "indices": 6}}]}}],
"skins": [{{"joints": [2, 3], "inverseBindMatrices": 3}}],
"animations": [{{"name": "bend", "samplers": [{{"input": 4, "output": 5}}],
                "channels": [{{"sampler": 0, "target": {{"node": 3, "path": "rotation"}}}}]}}{}],
"buffers": [{{"uri": "data:application/octet-stream;base64,{}", "byteLength": {}}}],
"bufferViews": [{}], "accessors": [{}]}}
)",
        aside, root.x(), root.y(), root.z(), more_animations, bench::base64(std::as_bytes(std::span(bytes))), bytes.size(),
        fmt::join(views, ", "), fmt::join(accessors, ", "));
  }

  static constexpr double aside = 3;  ///< of the node of the skin
  const Vector3d root{0.5, -1, 0.25};
  std::vector<Vector3d> vertices;
  std::vector<double> bent;  ///< weights of the second joint
  std::vector<int> triangles;

 private:
  static void append(std::string& bytes, double number) {
    const auto single = static_cast<float>(number);
    bytes.append(reinterpret_cast<const char*>(&single), sizeof single);
  }
  static void append(std::string& bytes, const Vector3d& v) {
    for (const double x : v) append(bytes, x);
  }
};

class SkinnedTube : public testing::Test {
 protected:
  SkinnedTube() { write(tube_.gltf()); }
  void write(const std::string& gltf) const { std::ofstream(file_) << gltf; }
  ObstacleRule rule(const std::string& more) const {
    return obstacle(fmt::format("shape = 'mesh', file = '{}'{}", file_, more));
  }
  std::string refusal(const std::string& more) const {
    try {
      Obstacle{rule(more)};
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  base::TemporaryFolder folder_;
  std::string file_ = folder_ / "tube.gltf";
  Tube tube_;
};

TEST_F(SkinnedTube, IsAtRestWithoutItsAnimation) {
  const ObstacleRule still = rule("");
  EXPECT_FALSE(moves(still));
  const Obstacle tube(still);
  EXPECT_EQ(tube.deforming(), nullptr);
  EXPECT_NEAR(tube.nearest({Tube::aside, 0, 3}).distance, 1, 1e-15);
  EXPECT_NEAR(tube.nearest({Tube::aside + 1, 0.1, 1.1}).distance, 0.75, 1e-15);
}

TEST_F(SkinnedTube, IsSkinnedLinearly) {
  for (const std::string name : {"bend", "0"}) {
    const ObstacleRule bending = rule(fmt::format(", scale = 0.5, animation = '{}', rate = 10", name));
    EXPECT_TRUE(moves(bending));
    const Obstacle tube(bending);
    ASSERT_NE(tube.deforming(), nullptr);
    const model::MovingMesh& mesh = tube.deforming()->moving();
    std::vector<Vector3d> places = mesh.first().vertices;
    ASSERT_EQ(places.size(), 4U * Tube::rings) << "the vertices of the caps are those of the sides";
    for (int v = 0; v < std::ssize(places); ++v) EXPECT_LE((places[v] - 0.5 * tube_.skinned(v, 0)).norm(), 1e-6);
    for (const double t : {0.0, 0.1, 0.7, 1.0}) {
      mesh.place(t, places);
      for (int v = 0; v < std::ssize(places); ++v)
        EXPECT_LE((places[v] - 0.5 * tube_.skinned(v, t)).norm(), 1e-6) << t << " " << v;
    }
    mesh.place(0.43, places);
    for (int v = 0; v < std::ssize(places); ++v) {
      const Vector3d between = 0.35 * tube_.skinned(v, 0.4) + 0.15 * tube_.skinned(v, 0.5);
      EXPECT_LE((places[v] - between).norm(), 1e-6) << v;
      EXPECT_LE((mesh.velocity(0.43, v) - 5 * (tube_.skinned(v, 0.5) - tube_.skinned(v, 0.4))).norm(), 1e-5) << v;
    }
    mesh.place(9, places);
    for (int v = 0; v < std::ssize(places); ++v) EXPECT_LE((places[v] - 0.5 * tube_.skinned(v, 1)).norm(), 1e-6) << v;
  }
}

TEST_F(SkinnedTube, IsSampledAtItsRateAndAtItsEnd) {
  const auto times = [&](double rate, double start = 0) {
    std::vector<double> all;
    for (const model::KeyVertices& key : model::read_animation(file_, {"bend", rate, start}).keys) all.push_back(key.t);
    return all;
  };
  EXPECT_THAT(times(2.5), testing::ElementsAre(0, 0.4, 0.8, 1));
  EXPECT_THAT(times(2.5, 0.5), testing::ElementsAre(0, testing::DoubleNear(0.4, 1e-12), 0.5));
  EXPECT_THAT(times(3), testing::SizeIs(4));
  EXPECT_THAT(times(0.1), testing::ElementsAre(0, 1));
}

TEST_F(SkinnedTube, IsPlayedFromItsStart) {
  const Obstacle tube(rule(", animation = 'bend', rate = 10, start = 0.4"));
  const model::MovingMesh& mesh = tube.deforming()->moving();
  std::vector<Vector3d> places = mesh.first().vertices;
  for (int v = 0; v < std::ssize(places); ++v) EXPECT_LE((places[v] - tube_.skinned(v, 0.4)).norm(), 1e-6) << v;
  for (const auto& [t, of_animation] : {std::pair(-1.0, 0.4), {0.0, 0.4}, {0.2, 0.6}, {0.6, 1.0}, {9.0, 1.0}}) {
    mesh.place(t, places);
    for (int v = 0; v < std::ssize(places); ++v)
      EXPECT_LE((places[v] - tube_.skinned(v, of_animation)).norm(), 1e-6) << t << " " << v;
  }
}

TEST_F(SkinnedTube, IsDrawnWhereItIs) {
  const ObstacleRule bending = rule(", animation = 'bend', position = [0, 0, 1]");
  const model::PosedObstacle drawn(bending, 1);
  for (const double t : {0.0, 0.5, 1.0}) {
    const model::Polygons polygons = drawn.at(t);
    EXPECT_EQ(polygons.faces.size(), tube_.triangles.size() / 3);
    for (int v = 0; v < std::ssize(polygons.vertices); ++v)
      EXPECT_LE((polygons.vertices[v] - tube_.skinned(v, t) - Vector3d::UnitZ()).norm(), 1e-6) << t << " " << v;
  }
}

TEST_F(SkinnedTube, IsWrittenAndReadAgain) {
  const ObstacleRule bending = rule(", animation = 'bend', rate = 25");
  EXPECT_EQ(value_of(bending, "animation"), "\"bend\"");
  EXPECT_EQ(value_of(bending, "rate"), "25");
  EXPECT_EQ(value_of(rule(""), "rate"), "");
  EXPECT_EQ(value_of(rule(", animation = 'bend', start = 0.25"), "start"), "0.25");
  EXPECT_EQ(value_of(rule(""), "start"), "");
  const model::Scene scene =
      model::parse_scene("name = 'x'\nobstacles = [{ shape = 'mesh', file = '" + file_ + "', animation = 'bend' }]", "a.toml");
  EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "b.toml")), to_toml(scene));
  EXPECT_THAT(to_toml(scene), HasSubstr("rate = 60"));
}

TEST_F(SkinnedTube, IsRefusedWithoutSuchAnAnimation) {
  write(tube_.gltf(R"(, {"name": "twist", "samplers": [{"input": 4, "output": 5}],
                 "channels": [{"sampler": 0, "target": {"node": 3, "path": "rotation"}}]})"));
  EXPECT_EQ(refusal(", animation = 'twist'"), "");
  EXPECT_EQ(refusal(", animation = '1'"), "");
  EXPECT_EQ(refusal(", animation = 'walk'"), file_ + ": obstacles.animation = 'walk': expected one of \"bend\", \"twist\"");
  EXPECT_EQ(refusal(", animation = '2'"), file_ + ": obstacles.animation = '2': expected one of \"bend\", \"twist\"");
  for (const double start : {1, 2})
    EXPECT_EQ(refusal(fmt::format(", animation = 'bend', start = {}", start)),
              fmt::format("{}: obstacles.animation = 'bend': expected obstacles.start before its end at 1 s, not {} s", file_,
                          start));
  EXPECT_THAT(refusal(", animation = 'bend', rate = 1e9"),
              AllOf(StartsWith(file_ + ": obstacles.animation = 'bend': expected at most 5e+07 positions"), EndsWith("times")));
  write_mesh(folder_ / "box.ply", box_mesh({1, 1, 1}));
  EXPECT_THROW(
      try {
        Obstacle{obstacle("shape = 'mesh', file = '" + (folder_ / "box.ply").string() + "', animation = 'bend'")};
      } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(),
                    EndsWith("box.ply: obstacles.animation = 'bend': expected a file with animations, there are none"));
        throw;
      },
      std::invalid_argument);
}

TEST_F(SkinnedTube, IsRefusedWithMorphTargets) {
  std::string gltf = tube_.gltf(R"(, {"name": "swell", "samplers": [{"input": 4, "output": 4}],
                 "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]})");
  const std::string indices = R"("indices": 6)";
  gltf.replace(gltf.find(indices), indices.size(), indices + R"(, "targets": [{"POSITION": 0}])");
  write(gltf);
  EXPECT_EQ(refusal(", animation = 'bend'"), "");
  EXPECT_EQ(refusal(", animation = 'swell'"),
            file_ + ": obstacles.animation = 'swell': expected an animation of nodes and bones, not of morph targets");
}

TEST_F(SkinnedTube, IsRefusedWhereItTears) {
  tube_.bent[4 * Tube::rings] = 0.5;  // a corner of a cap follows the wrong joint
  write(tube_.gltf());
  EXPECT_EQ(refusal(""), "");
  EXPECT_THAT(refusal(", animation = 'bend', rate = 2"),
              AllOf(StartsWith(file_ +
                               ": obstacles.animation = 'bend' at 0.5 s: expected vertices to stay together that are in one "
                               "place in " +
                               file_),
                    EndsWith(" apart")));
}

// --- Frames that are refused -------------------------------------------------------------------------------------------------

std::string frames_refusal(const std::vector<std::pair<double, TriangleMesh>>& meshes) {
  try {
    Obstacle{obstacle(Frames(meshes).keys())};
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// Behind the folder: "1.ply: …".
std::string behind_folder(const std::string& text) {
  const std::size_t file = text.find(".ply");
  return text.substr(file == std::string::npos ? 0 : file - 1);
}

TEST(RefusedFrames, HaveOtherTriangles) {
  const TriangleMesh box = box_mesh({1, 1, 1});
  TriangleMesh turned = box;
  std::ranges::rotate(turned.triangles, turned.triangles.begin() + 1);
  EXPECT_EQ(frames_refusal({{0, box}, {1, box_mesh({2, 1, 1})}}), "");
  EXPECT_THAT(behind_folder(frames_refusal({{0, box}, {1, turned}})),
              AllOf(StartsWith("1.ply: obstacles.frames: expected the faces of "), EndsWith("0.ply, in their order")));
  EXPECT_THAT(behind_folder(frames_refusal({{0, box}, {1, spiky_mesh(1)}})),
              AllOf(StartsWith("1.ply: obstacles.frames: expected 8 vertices as in "), EndsWith("0.ply, not 66")));
}

TEST(RefusedFrames, AreInsideOutOrFlat) {
  const TriangleMesh box = box_mesh({1, 1, 1});
  const auto mirror = [](const Vector3d& v) -> Vector3d { return {-v.x(), v.y(), v.z()}; };
  const auto flat = [](const Vector3d& v) -> Vector3d { return {v.x(), v.y(), 0}; };
  const auto pinched = [](const Vector3d& v) -> Vector3d { return v.x() > 0 && v.z() > 0 ? Vector3d(0.5, 0, 0.5) : v; };
  EXPECT_EQ(behind_folder(frames_refusal({{0, box}, {1, moved(box, mirror)}})),
            "1.ply: obstacles.frames: expected a mesh that is not inside out");
  EXPECT_THAT(behind_folder(frames_refusal({{0, box}, {1, moved(box, flat)}})),
              StartsWith("1.ply: obstacles.frames: expected triangles with an area, the one at ("));
  EXPECT_EQ(behind_folder(frames_refusal({{0, box}, {1, moved(box, pinched)}})),
            "1.ply: obstacles.frames: expected triangles with an area, the one at (-0.5, -0.5, 0.5) has none");
  EXPECT_EQ(frames_refusal({{0, moved(box, mirror)}, {1, moved(box, mirror)}}), "") << "both are turned round";
}

TEST(RefusedFrames, TearWhatIsOne) {
  const base::TemporaryFolder folder;
  const std::string one = folder / "0.stl", other = folder / "1.stl";
  TriangleMesh box = box_mesh({1, 1, 1});
  write_mesh(one, box);
  std::swap(box.triangles[3], box.triangles[8]);  // each triangle of STL has vertices of its own
  write_mesh(other, box);
  EXPECT_THROW(
      try {
        model::read_frames(one, std::vector<model::FrameFile>{{0, one}, {1, other}});
      } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(),
                    AllOf(StartsWith(other + ": obstacles.frames: expected vertices to stay together that are in one place"),
                          HasSubstr(one)));
        throw;
      },
      std::invalid_argument);
}

std::string scene_refusal(const std::string& more) {
  const base::TemporaryFolder folder;
  write_mesh(folder / "a.ply", box_mesh({1, 1, 1}));
  const std::string file = folder / "scene.toml";
  std::ofstream(file) << "[[obstacles]]\nshape = 'mesh'\nfile = 'a.ply'\n" << more << "\n";
  try {
    model::load_scene(file);
  } catch (const model::SceneError& error) {
    const std::string said = error.what();
    return said.substr(std::min(said.size(), file.size()));
  }
  return "";
}

TEST(RefusedFrames, AreSaidInOneLine) {
  EXPECT_EQ(scene_refusal("frames = [{ time = 0, file = 'a.ply' }]"), "");
  EXPECT_EQ(scene_refusal("frames = []"), ":4: obstacles.frames = []: expected at least one frame");
  EXPECT_THAT(scene_refusal("frames = [{ time = 1, file = 'a.ply' }, { time = 1, file = 'a.ply' }]"),
              AllOf(StartsWith(":4: obstacles.frames = "), EndsWith(": expected frames with times that ascend")));
  EXPECT_THAT(scene_refusal("frames = [{ time = 1 }]"), EndsWith(": expected 'file' in every frame of a mesh"));
  EXPECT_THAT(scene_refusal("frames = [{ file = 'a.ply' }]"), EndsWith(": expected 'time' in every frame of a mesh"));
  EXPECT_THAT(scene_refusal("frames = [{ time = 1, file = 'b.ply' }]"),
              AllOf(StartsWith(":4: obstacles.frames.file = 'b.ply': expected the file of a mesh, "),
                    EndsWith("b.ply: there is no such file")));
  EXPECT_THAT(scene_refusal("frames = [{ time = 1, file = 'a.ply', checksum = 'x' }]"),
              AllOf(StartsWith(":4: obstacles.frames.checksum = 'x': expected "), EndsWith("a.ply")));
  EXPECT_EQ(scene_refusal("animation = ''"),
            ":4: obstacles.animation = '': expected the name of an animation, or its index in quotes");
  EXPECT_EQ(scene_refusal("frames = [{ time = 0, file = 'a.ply' }]\nanimation = 'walk'"),
            ":5: obstacles.animation = 'walk': expected 'frames' or 'animation', not both");
  EXPECT_EQ(scene_refusal("rate = 30"), ":4: obstacles.rate = 30: expected 'animation' beside it");
  EXPECT_EQ(scene_refusal("animation = 'walk'\nrate = 0"), ":5: obstacles.rate = 0: expected a number above 0");
  EXPECT_EQ(scene_refusal("start = 1"), ":4: obstacles.start = 1: expected 'animation' beside it");
  EXPECT_EQ(scene_refusal("animation = 'walk'\nstart = -1"), ":5: obstacles.start = -1: expected a number of at least 0");
}

TEST(FramesOfAScene, AreWrittenWithTheirChecksums) {
  const Frames frames({{0, box_mesh({1, 1, 1})}, {1, box_mesh({2, 1, 1})}});
  const model::Scene scene = model::parse_scene("name = 'x'\nobstacles = [{" + frames.keys() + "}]", "a.toml");
  const std::string text = to_toml(scene);
  EXPECT_EQ(to_toml(model::parse_scene(text, "b.toml")), text);
  const std::string one = value_of(scene.obstacles[0], "frames");
  EXPECT_THAT(one, AllOf(HasSubstr("checksum = "), HasSubstr("0.ply"), HasSubstr("1.ply")));
  write_mesh(frames.first(), box_mesh({1, 1, 2}));
  EXPECT_THROW(model::parse_scene(text, "b.toml"), model::SceneError) << "one of them has changed";
}

}  // namespace
}  // namespace drape::verify::deforming_mesh_test
