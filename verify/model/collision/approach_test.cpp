// The first time at which a moving pair comes near, against samples of the whole motion.

#include "model/collision/approach.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace drape::verify::approach_test {
namespace {

using Eigen::Vector3d;
using model::FourPoints;
using model::PairKind;

double distance_at(PairKind kind, const FourPoints& x0, const FourPoints& x1, double part) {
  return model::proximity(kind, model::points_between(x0, x1, part)).distance;
}

TEST(FirstApproach, IsNeverLateAndEndsNear) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::normal_distribution<double> move(0, 0.7);
  int reached = 0, begun = 0, never = 0;
  for (int k = 0; k < 10000; ++k) {
    const PairKind kind = k % 2 == 0 ? PairKind::vertex_face : PairKind::edge_edge;
    const double distance = k % 3 == 0 ? 0.01 : k % 3 == 1 ? 0.1 : 0.4;
    FourPoints x0, x1;
    for (int i = 0; i < 4; ++i)
      for (int c = 0; c < 3; ++c) {
        x0[i][c] = coordinate(random);
        x1[i][c] = x0[i][c] + move(random);
      }
    const auto part = model::first_approach(kind, x0, x1, distance);
    constexpr int samples = 300;
    for (int s = 0; s <= samples; ++s)
      if (const double at = s / double(samples); !part || at < *part) {
        ASSERT_GT(distance_at(kind, x0, x1, at), distance) << "motion " << k << " at " << at;
      }
    (part ? *part > 0 ? reached : begun : never) += 1;
    if (!part) continue;
    ASSERT_LE(*part, 1);
    ASSERT_LE(distance_at(kind, x0, x1, *part), model::reached(distance)) << "motion " << k;
  }
  EXPECT_GT(reached, 1000);
  EXPECT_GT(begun, 500);
  EXPECT_GT(never, 1000);
}

/// A millionth before it the distance is still larger, and larger by what the tolerance is worth.
TEST(FirstApproach, IsExactWhereTheMotionIsKnown) {
  const FourPoints falling0{Vector3d(0.2, 0.2, 1), Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  FourPoints falling1 = falling0;
  falling1[0].z() = -3;
  const auto fall = model::first_approach(PairKind::vertex_face, falling0, falling1, 0.2);
  ASSERT_TRUE(fall);
  EXPECT_LE(*fall, 0.2);
  EXPECT_GE(*fall, 0.2 - 1e-4 * 0.2 / 4);
  const FourPoints crossing0{Vector3d(-1, 0, 2), Vector3d(1, 0, 2), Vector3d(0, -1, 0), Vector3d(0, 1, 0)};
  const FourPoints crossing1{Vector3d(-1, 0, -2), Vector3d(1, 0, -2), Vector3d(0, -1, 0), Vector3d(0, 1, 0)};
  const auto crossing = model::first_approach(PairKind::edge_edge, crossing0, crossing1, 0);
  ASSERT_TRUE(crossing);
  EXPECT_LE(*crossing, 0.5);
  EXPECT_GE(*crossing, 0.5 - 1e-12);
}

TEST(FirstApproach, IsFoundHoweverFastPairsPass) {
  const FourPoints x0{Vector3d(0.2, 0.2, 1), Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  FourPoints x1 = x0;
  x1[0].z() = -1e6;
  EXPECT_TRUE(model::first_approach(PairKind::vertex_face, x0, x1, 1e-3));
}

TEST(FirstApproach, IsZeroOfThoseThatBeginNearAndNoneOfThoseThatStayAway) {
  const FourPoints x{Vector3d(0.2, 0.2, 1), Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  FourPoints up = x, along = x;
  up[0].z() = 9;
  for (Vector3d& p : along) p += Vector3d(5, 6, -7);
  EXPECT_EQ(model::first_approach(PairKind::vertex_face, x, up, 2), 0);
  EXPECT_FALSE(model::first_approach(PairKind::vertex_face, x, up, 0.5));
  EXPECT_FALSE(model::first_approach(PairKind::vertex_face, x, along, 0.5));
  EXPECT_FALSE(model::first_approach(PairKind::vertex_face, x, x, 0.5)) << "at rest";
}

}  // namespace
}  // namespace drape::verify::approach_test
