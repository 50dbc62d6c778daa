// The mannequin: a union of round cones, each met for itself.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "model/obstacles/contacts.hpp"
#include "model/obstacles/obstacle.hpp"
#include "model/obstacles/surface.hpp"
#include "verify/support/distance_field.hpp"
#include "verify/support/obstacles.hpp"

namespace drape::verify::mannequin_test {
namespace {

using Eigen::Vector3d;
using model::Obstacle;
using model::ObstacleRule;

ObstacleRule mannequin(const std::string& keys = "") { return obstacle("shape = 'mannequin'" + keys); }

TEST(Mannequin, IsMadeOfExactShapes) {
  const ObstacleRule rule = mannequin(", arms = 40");
  const auto parts = rule.shape->parts();
  EXPECT_GT(parts.size(), 12u);
  for (const auto& part : parts) {
    const Vector3d middle(0, 0, 0.9);
    expect_distance_field([&](const Vector3d& p) { return part->nearest(p + middle); }, 1.2);
  }
}

/// The distance of the union is that of the nearest part: exact outside, nowhere more than it is.
TEST(Mannequin, IsTheUnionOfItsParts) {
  const ObstacleRule rule = mannequin();
  const Obstacle whole(rule);
  const auto parts = rule.shape->parts();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-0.6, 0.6);
  for (int k = 0; k < 400; ++k) {
    const Vector3d p(coordinate(random), coordinate(random), 0.9 + 1.7 * coordinate(random));
    double least = 1e9;
    for (const auto& part : parts) least = std::min(least, part->nearest(p).distance);
    const auto [distance, normal] = whole.nearest(p);
    EXPECT_EQ(distance, least);
    if (distance > 0) {
      EXPECT_NEAR(whole.nearest(p - distance * normal).distance, 0, 1e-14);
    }
  }
}

TEST(Mannequin, StandsOnItsSolesAndIsAsHighAsWished) {
  for (const double height : {1.7, 1.2}) {
    const ObstacleRule rule = mannequin(fmt::format(", height = {}", height));
    const Obstacle whole(rule);
    const auto surface = rule.shape->surface(1).vertices;
    const auto [lowest, highest] = std::ranges::minmax(surface, {}, [](const Vector3d& v) { return v.z(); });
    EXPECT_NEAR(lowest.z(), 0, 2e-3);
    EXPECT_GE(lowest.z(), 0);
    EXPECT_NEAR(highest.z(), height, 2e-3);
    EXPECT_LE(highest.z(), height + 1e-12);
    for (const Vector3d& v : surface) EXPECT_LE(whole.nearest(v).distance, 1e-12);
  }
}

TEST(Mannequin, IsTheSameOnBothSides) {
  const Obstacle whole(mannequin(", arms = 60"));
  for (const Vector3d& p : {Vector3d(0.3, 0.2, 1.1), Vector3d(0.05, -0.3, 0.5), Vector3d(0.7, 0.1, 1.5)}) {
    const auto right = whole.nearest(p), left = whole.nearest({-p.x(), p.y(), p.z()});
    EXPECT_NEAR(right.distance, left.distance, 1e-14);
    EXPECT_NEAR(right.normal.x(), -left.normal.x(), 1e-12);
  }
}

TEST(Mannequin, StretchesItsArmsToTheSides) {
  const Vector3d beside(0.7, 0.01, 1.39);
  EXPECT_LT(Obstacle(mannequin(", arms = 90")).nearest(beside).distance, 0);
  EXPECT_GT(Obstacle(mannequin(", arms = 0")).nearest(beside).distance, 0.3);
}

/// Between an arm and the trunk a particle has a contact with each.
TEST(Mannequin, GivesContactsWithAllPartsInReach) {
  solver::Counters work;
  const ObstacleRule rule = mannequin(", arms = 10, friction = 0.2");
  model::Contacts contacts(std::vector{rule}, {.distance = 0.1}, Vector3d::Zero(), 1, work);
  solver::State y;
  y.x = Eigen::RowVector3d(0.2, 0.01, 1.1);
  y.v = Eigen::RowVector3d::Zero();
  std::vector<solver::Contact> found;
  contacts.find(0, 0.01, y, found);
  const auto towards = [&](double sign) {
    return std::ranges::any_of(found, [&](const solver::Contact& c) { return sign * c.normal.x() > 0.8; });
  };
  EXPECT_TRUE(towards(1)) << "trunk";
  EXPECT_TRUE(towards(-1)) << "arm";
  for (const solver::Contact& c : found) EXPECT_EQ(c.friction, 0.2);
}

/// The left ankle is spread about the hip, the right one is its mirror image.
TEST(Mannequin, SpreadsItsLegs) {
  const Obstacle straight(mannequin()), spread(mannequin(", legs = 12"));
  const double angle = 12 * std::numbers::pi / 180, x = 0.01, z = -0.82;
  const Vector3d ankle(0.09 + x * std::cos(angle) - z * std::sin(angle), 0.01, 0.9 + x * std::sin(angle) + z * std::cos(angle));
  EXPECT_NEAR(spread.nearest(ankle).distance, straight.nearest({0.1, 0.01, 0.08}).distance, 1e-12);
  EXPECT_NEAR(spread.nearest({-ankle.x(), ankle.y(), ankle.z()}).distance, spread.nearest(ankle).distance, 1e-12);
  EXPECT_GT(spread.nearest({0, 0, 0.7}).distance, straight.nearest({0, 0, 0.7}).distance + 0.02);
}

// --- Walking ---------------------------------------------------------------------------------------------------------------

constexpr double speed = 1.2, from = 0.5;

std::vector<Obstacle> walking() { return parts_of(mannequin(", walk = 1.2, walk_from = 0.5, arms = 30")); }

/// The parts of a side, which follow seven of the trunk.
enum Part : std::size_t { upper_arm, forearm, hand, thigh, shank, foot, count };
std::size_t of_side(double side, Part part) { return 7 + (side < 0 ? std::size_t{0} : std::size_t{count}) + part; }

Vector3d moved(const Obstacle& part, const Vector3d& p, double t) { return part.pose(t).to_world(p); }

TEST(WalkingMannequin, StandsBeforeItWalks) {
  for (const Obstacle& part : walking())
    for (const double t : {0.0, 0.3, from}) EXPECT_LE((moved(part, {0.3, 0.2, 1}, t) - Vector3d(0.3, 0.2, 1)).norm(), 1e-14);
  EXPECT_FALSE(moves(mannequin()));
  EXPECT_TRUE(moves(mannequin(", walk = 1.2")));
}

TEST(WalkingMannequin, KeepsItsJoints) {
  const auto parts = walking();
  for (const double side : {-1.0, 1.0}) {
    const Vector3d hip(side * 0.09, 0, 0.9), knee(side * 0.095, -0.005, 0.48), shoulder(side * 0.165, 0.01, 1.39);
    const double angle = 30 * std::numbers::pi / 180;
    const Vector3d elbow = shoulder + 0.29 * Vector3d(side * std::sin(angle), 0, -std::cos(angle));
    for (double t = 0; t < 4; t += 0.07) {
      const auto joint = [&](std::size_t one, std::size_t other, const Vector3d& p) {
        EXPECT_LE((moved(parts[one], p, t) - moved(parts[other], p, t)).norm(), 1e-12) << t;
      };
      joint(0, of_side(side, thigh), hip);
      joint(of_side(side, thigh), of_side(side, shank), knee);
      joint(of_side(side, shank), of_side(side, foot), knee);
      joint(0, of_side(side, upper_arm), shoulder);
      joint(of_side(side, upper_arm), of_side(side, forearm), elbow);
      joint(of_side(side, forearm), of_side(side, hand), elbow);
    }
  }
}

TEST(WalkingMannequin, WalksAtItsSpeedByEqualSteps) {
  const auto parts = walking();
  const double cycle = 0.8 * 1.7 / speed;
  const Vector3d p(0, 0, 1.3), way = moved(parts[0], p, 3 + cycle) - moved(parts[0], p, 3);
  EXPECT_LE((way - Vector3d(0, -speed * cycle, 0)).norm(), 1e-12);
  // Half a cycle later the other leg is where this one was.
  const Vector3d left_ankle(-0.1, 0.01, 0.08), right_ankle(0.1, 0.01, 0.08);
  for (double t = 2; t < 3; t += 0.1) {
    const Vector3d left = moved(parts[of_side(-1, shank)], left_ankle, t);
    const Vector3d right = moved(parts[of_side(1, shank)], right_ankle, t + cycle / 2);
    EXPECT_LE((right - left - Vector3d(0.2, -speed * cycle / 2, 0)).norm(), 1e-12);
  }
}

/// Legs swing to both sides of the hip, knees bend backwards only, the arms swing against the legs.
TEST(WalkingMannequin, SwingsItsLimbs) {
  const auto parts = walking();
  double farthest = 0, hindmost = 0;
  for (double t = 2; t < 4; t += 0.01) {
    const auto forwards = [&](std::size_t part, const Vector3d& joint, const Vector3d& end) {
      return moved(parts[part], joint, t).y() - moved(parts[part], end, t).y();
    };
    const double leg = forwards(of_side(1, thigh), {0.09, 0, 0.9}, {0.095, -0.005, 0.48});
    const double arm = forwards(of_side(1, upper_arm), {0.165, 0.01, 1.39}, {0.31, 0.01, 1.139});
    farthest = std::max(farthest, leg), hindmost = std::min(hindmost, leg);
    if (std::abs(leg - 0.05) > 0.03) {
      EXPECT_LT(arm * (leg - 0.05), 0) << t;
    }
    const Vector3d hip = moved(parts[of_side(1, thigh)], {0.09, 0, 0.9}, t);
    const Vector3d knee = moved(parts[of_side(1, thigh)], {0.095, -0.005, 0.48}, t);
    const Vector3d ankle = moved(parts[of_side(1, shank)], {0.1, 0.01, 0.08}, t);
    EXPECT_GT((knee - hip).cross(ankle - knee).x(), 0) << t;
  }
  EXPECT_NEAR(farthest, 0.42 * std::sin(28 * std::numbers::pi / 180), 0.01);
  EXPECT_NEAR(hindmost, -0.42 * std::sin(16 * std::numbers::pi / 180), 0.01);
}

/// Cloth is carried along: what touches a part that swings has its velocity.
TEST(WalkingMannequin, HasTheVelocityOfItsParts) {
  model::ContactRule rule;
  solver::Counters work;
  const std::vector<ObstacleRule> rules{mannequin(", walk = 1.2, walk_from = 0.5, arms = 30")};
  model::Contacts contacts(rules, rule, {0, 0, -9.81}, 1, work);
  const auto parts = walking();
  const double t = 2.2, h = 1e-4;
  const Vector3d knee(0.095, -0.005 - 0.052 - 0.004, 0.5);  // before the knee
  solver::State y{moved(parts[of_side(1, thigh)], knee, t).transpose(), solver::Vectors::Zero(1, 3)};
  std::vector<solver::Contact> found;
  contacts.find(t, h, y, found);
  const auto mine = std::ranges::find(found, int(of_side(1, thigh)), &solver::Contact::obstacle);
  ASSERT_NE(mine, found.end());
  const Vector3d velocity = (moved(parts[of_side(1, thigh)], knee, t + h) - moved(parts[of_side(1, thigh)], knee, t)) / h;
  EXPECT_LE((mine->velocity - velocity).norm(), 0.02 * velocity.norm());
  EXPECT_GT(velocity.norm(), 0.3);
}

TEST(WalkingMannequin, IsDrawnPartByPart) {
  const ObstacleRule rule = mannequin(", walk = 1.2");
  const std::size_t whole = rule.shape->surface(1).vertices.size();
  std::size_t sum = 0;
  for (std::size_t k = 0; k < parts_of(rule).size(); ++k) sum += rule.shape->surface_of_part(k, 1).vertices.size();
  EXPECT_EQ(sum, whole);
  EXPECT_EQ(model::PosedObstacle(rule, 1).at(2).vertices.size(), whole);
}

}  // namespace
}  // namespace drape::verify::mannequin_test
