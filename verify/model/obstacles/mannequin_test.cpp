// The mannequin: a union of round cones, each met for itself.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "model/obstacles/contacts.hpp"
#include "model/obstacles/obstacle.hpp"
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
  model::Contacts contacts(std::vector{rule}, {.distance = 0.1}, 0, 1, work);
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

}  // namespace
}  // namespace drape::verify::mannequin_test
