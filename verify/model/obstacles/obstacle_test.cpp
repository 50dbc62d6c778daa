// Obstacles with exact formulas, and how obstacles move.

#include "model/obstacles/obstacle.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "verify/support/distance_field.hpp"
#include "verify/support/obstacles.hpp"

namespace drape::verify::obstacle_test {
namespace {

using Eigen::Vector3d;
using model::Nearest;
using model::Obstacle;
using model::Pose;

Obstacle plane() { return Obstacle(obstacle("shape = 'plane'")); }
Obstacle sphere(double radius) { return Obstacle(obstacle(fmt::format("shape = 'sphere', radius = {}", radius))); }
Obstacle box(const Vector3d& size) {
  return Obstacle(obstacle(fmt::format("shape = 'box', size = [{}, {}, {}]", size[0], size[1], size[2])));
}
Obstacle cylinder(double radius, double height) {
  return Obstacle(obstacle(fmt::format("shape = 'cylinder', radius = {}, height = {}", radius, height)));
}

// --- Distances ---------------------------------------------------------------------------------------------------------------

/// What is known about a point.
struct Known {
  std::string name;
  Obstacle obstacle;
  Vector3d p;
  double distance;
  Vector3d normal;
};

void PrintTo(const Known& known, std::ostream* out) { *out << known.name; }

// clang-format off
const std::vector<Known> known_points = {
    {"above_a_plane", plane(), {5, -7, 2}, 2, {0, 0, 1}},
    {"below_a_plane", plane(), {5, -7, -3}, -3, {0, 0, 1}},
    {"outside_a_sphere", sphere(2), {0, -3, 4}, 3, {0, -0.6, 0.8}},
    {"inside_a_sphere", sphere(2), {0.3, 0.4, 0}, -1.5, {0.6, 0.8, 0}},
    {"beside_a_face", box({2, 4, 6}), {-3, 0.5, -1}, 2, {-1, 0, 0}},
    {"beside_an_edge", box({2, 4, 6}), {4, -6, 0.5}, 5, {0.6, -0.8, 0}},
    {"beside_a_corner", box({2, 4, 6}), {-3, 5, 9}, 7, {-2. / 7, 3. / 7, 6. / 7}},
    {"on_a_face", box({2, 4, 6}), {0.5, 1, 3}, 0, {0, 0, 1}},
    {"inside_a_box_near_x", box({2, 4, 6}), {0.5, 0.6, 0.7}, -0.5, {1, 0, 0}},
    {"inside_a_box_near_y", box({2, 4, 6}), {0.2, -1.75, 0.3}, -0.25, {0, -1, 0}},
    {"inside_a_box_near_z", box({2, 4, 6}), {0.2, 0.2, -2.5}, -0.5, {0, 0, -1}},
    {"beside_the_side_of_a_cylinder", cylinder(2, 2), {-1.8, 2.4, 0.5}, 1, {-0.6, 0.8, 0}},
    {"above_a_cylinder", cylinder(2, 2), {1, 0, 4}, 3, {0, 0, 1}},
    {"on_the_axis_below_a_cylinder", cylinder(2, 2), {0, 0, -4}, 3, {0, 0, -1}},
    {"beside_the_rim_of_a_cylinder", cylinder(2, 2), {3, -4, -5}, 5, {0.36, -0.48, -0.8}},
    {"inside_a_cylinder_near_its_side", cylinder(2, 2), {0, -1.75, 0.5}, -0.25, {0, -1, 0}},
    {"inside_a_cylinder_near_its_top", cylinder(2, 2), {0.2, 0.1, 0.75}, -0.25, {0, 0, 1}},
};
// clang-format on

class KnownPoint : public testing::TestWithParam<Known> {};
INSTANTIATE_TEST_SUITE_P(, KnownPoint, testing::ValuesIn(known_points), [](const auto& test) { return test.param.name; });

TEST_P(KnownPoint, HasItsDistanceAndNormal) {
  const Nearest nearest = GetParam().obstacle.nearest(GetParam().p);
  EXPECT_NEAR(nearest.distance, GetParam().distance, 1e-15);
  EXPECT_LE((nearest.normal - GetParam().normal).norm(), 1e-15);
}

TEST(Distance, GrowsAlongTheNormalFromTheNearestPoint) {
  for (const Obstacle& obstacle : {plane(), sphere(1), box({1, 2, 1.5}), cylinder(1, 0.5), cylinder(0.3, 2)})
    expect_distance_field([&](const Vector3d& p) { return obstacle.nearest(p); }, 2);
}

TEST(Distance, IsFoundWrongByItsChecker) {
  const auto errors = [](auto spoil) {
    return field_errors(
        [&](const Vector3d& p) {
          const auto [distance, normal] = sphere(1).nearest(p);
          return spoil(distance, normal);
        },
        2);
  };
  EXPECT_GT(errors([](double d, const Vector3d& n) { return Nearest{1.1 * d, n}; }).growth, 1e-3);
  EXPECT_GT(errors([](double d, const Vector3d& n) { return Nearest{d, 1.01 * n}; }).length, 1e-3);
  EXPECT_GT(errors([](double d, const Vector3d& n) { return Nearest{d, -n}; }).gradient, 1);
  EXPECT_GT(errors([](double d, const Vector3d& n) { return Nearest{1.1 * d, n}; }).surface, 1e-3);
}

TEST(Distance, HasANormalWhereSeveralPartsAreEquallyNear) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(-0., -0., -0.), Vector3d(tiny, -tiny, tiny), Vector3d(0, 0, 0.25)}) {
    for (const Obstacle& obstacle : {sphere(1), box({2, 2, 2}), cylinder(1, 4)}) {
      const Nearest nearest = obstacle.nearest(p);
      EXPECT_NEAR(nearest.normal.norm(), 1, 1e-15);
      EXPECT_LE(nearest.distance, -0.75);
    }
  }
}

TEST(Distance, HasANormalOnEdgesAndCorners) {
  EXPECT_NEAR(box({2, 2, 2}).nearest({1, -1, 1}).normal.norm(), 1, 1e-15);
  EXPECT_NEAR(cylinder(1, 2).nearest({0, 1, -1}).normal.norm(), 1, 1e-15);
  EXPECT_EQ(box({2, 2, 2}).nearest({1, -1, 1}).distance, 0);
  EXPECT_EQ(cylinder(1, 2).nearest({0, 1, -1}).distance, 0);
}

// --- Motion ------------------------------------------------------------------------------------------------------------------

/// A plane that moves thus.
Obstacle moving(const std::vector<model::KeyFrame>& motion) {
  model::ObstacleRule rule = obstacle("shape = 'plane'");
  rule.motion = motion;
  return Obstacle(rule);
}

const std::vector<model::KeyFrame> quarter_turns = {
    {.t = 1, .position = {1, 0, 0}}, {.t = 3, .position = {3, 4, 0}, .rotation = {0, 0, 90}}, {.t = 4, .rotation = {0, 90, 0}}};

void expect_pose(const Pose& pose, const Vector3d& position, const Vector3d& x_axis, const Vector3d& y_axis) {
  EXPECT_LE((pose.position - position).norm(), 1e-15);
  EXPECT_LE((pose.rotation * Vector3d::UnitX() - x_axis).norm(), 1e-15);
  EXPECT_LE((pose.rotation * Vector3d::UnitY() - y_axis).norm(), 1e-15);
}

TEST(Motion, PassesThroughItsKeyFrames) {
  const Obstacle obstacle = moving(quarter_turns);
  expect_pose(obstacle.pose(1), {1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect_pose(obstacle.pose(3), {3, 4, 0}, {0, 1, 0}, {-1, 0, 0});
  expect_pose(obstacle.pose(4), {0, 0, 0}, {0, 0, -1}, {0, 1, 0});
}

TEST(Motion, RestsBeforeTheFirstAndAfterTheLastKeyFrame) {
  const Obstacle obstacle = moving(quarter_turns);
  expect_pose(obstacle.pose(-1), {1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect_pose(obstacle.pose(9), {0, 0, 0}, {0, 0, -1}, {0, 1, 0});
}

TEST(Motion, OfOneKeyFrameIsRest) {
  const Obstacle obstacle = moving({{.t = 2, .position = {1, 2, 3}, .rotation = {0, 0, 180}}});
  for (const double t : {0., 2., 5.}) expect_pose(obstacle.pose(t), {1, 2, 3}, {-1, 0, 0}, {0, -1, 0});
}

TEST(Motion, BetweenKeyFramesHasConstantVelocities) {
  const double c = std::cos(M_PI / 8), s = std::sin(M_PI / 8), d = std::sqrt(0.5);
  const Obstacle obstacle = moving(quarter_turns);
  expect_pose(obstacle.pose(1.5), {1.5, 1, 0}, {c, s, 0}, {-s, c, 0});
  expect_pose(obstacle.pose(2), {2, 2, 0}, {d, d, 0}, {-d, d, 0});
  expect_pose(obstacle.pose(2.5), {2.5, 3, 0}, {s, c, 0}, {-c, s, 0});
  const Pose from = obstacle.pose(3), to = obstacle.pose(4);
  const double turn = from.rotation.angularDistance(to.rotation);
  EXPECT_NEAR(turn, 2 * M_PI / 3, 1e-15);
  EXPECT_NEAR(from.rotation.angularDistance(obstacle.pose(3.25).rotation), 0.25 * turn, 1e-15);
  EXPECT_NEAR(to.rotation.angularDistance(obstacle.pose(3.25).rotation), 0.75 * turn, 1e-15);
}

TEST(Motion, TurnsTheShorterWay) {
  const Obstacle obstacle = moving({{.t = 0}, {.t = 3, .rotation = {0, 0, 270}}});
  expect_pose(obstacle.pose(1), {0, 0, 0}, {std::cos(M_PI / 6), -0.5, 0}, {0.5, std::cos(M_PI / 6), 0});
}

TEST(Motion, KeepsSmallTurnsToRoundOff) {
  const double small = 1e-6;
  const Obstacle obstacle = moving({{.t = 0}, {.t = 1, .rotation = {0, 0, small}}});
  const double radians = small * M_PI / 180;
  EXPECT_NEAR(2 * obstacle.pose(0.3).rotation.z(), 0.3 * radians, 1e-16);
  EXPECT_NEAR(obstacle.pose(0.3).rotation.norm(), 1, 1e-15);
}

TEST(Pose, ToBodyUndoesToWorld) {
  const Pose pose = moving(quarter_turns).pose(3.7);
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(1, -2, 3), Vector3d(-0.1, 0.2, 0.3)}) {
    EXPECT_LE((pose.to_body(pose.to_world(p)) - p).norm(), 4e-15);
    EXPECT_LE((pose.to_world(pose.to_body(p)) - p).norm(), 4e-15);
  }
  EXPECT_LE((moving(quarter_turns).pose(3).to_world({1, 2, 3}) - Vector3d(1, 5, 3)).norm(), 1e-15);
}

TEST(Obstacle, HasItsFriction) { EXPECT_EQ(Obstacle(obstacle("shape = 'plane', friction = 0.25")).friction(), 0.25); }

}  // namespace
}  // namespace drape::verify::obstacle_test
