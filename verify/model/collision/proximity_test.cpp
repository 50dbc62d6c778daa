// Nearest points of a vertex and a face, and of two edges: what makes them the nearest ones, also where they are degenerate.

#include "model/collision/proximity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "model/collision/exact_intersection.hpp"
#include "model/collision/face_distance.hpp"
#include "model/obstacles/triangle_mesh.hpp"

namespace drape::verify::proximity_test {
namespace {

using Eigen::Vector3d;
using model::Corners;
using model::FourPoints;
using model::PairKind;
using model::Proximity;

constexpr PairKind kinds[] = {PairKind::vertex_face, PairKind::edge_edge};

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : random_(seed) {}

  Vector3d anywhere() {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    return {coordinate(random_), coordinate(random_), coordinate(random_)};
  }

  /// Few places, so that points coincide, and lines are parallel.
  Vector3d on_lattice() {
    std::uniform_int_distribution<int> coordinate(0, 2);
    return Vector3d(coordinate(random_), coordinate(random_), coordinate(random_));
  }

 private:
  std::mt19937 random_;
};

int firsts(PairKind kind) { return kind == PairKind::vertex_face ? 1 : 2; }

/// Both points lie in the hulls of the corners, the vector between them is as it is said to be, and no corner lies on this side
/// of the planes across it: for convex sets that is where they are nearest.
void expect_nearest(PairKind kind, const FourPoints& x, double tolerance) {
  const Proximity found = model::proximity(kind, x);
  Vector3d first = Vector3d::Zero(), second = Vector3d::Zero();
  double all = 0, part = 0;
  for (int k = 0; k < 4; ++k) {
    const bool is_first = k < firsts(kind);
    const double weight = is_first ? found.weights[k] : -found.weights[k];
    EXPECT_GE(weight, 0);
    (is_first ? first : second) += weight * x[k];
    (is_first ? part : all) += weight;
  }
  EXPECT_NEAR(part, 1, 1e-14);
  EXPECT_NEAR(all, 1, 1e-14);
  EXPECT_NEAR(found.normal.norm(), 1, 1e-14);
  EXPECT_GE(found.distance, 0);
  EXPECT_LE((first - second - found.distance * found.normal).norm(), 1e-11);
  for (int k = 0; k < 4; ++k) {
    const double beyond = k < firsts(kind) ? (x[k] - first).dot(first - second) : (second - x[k]).dot(first - second);
    EXPECT_GE(beyond, -tolerance) << "corner " << k;
  }
}

TEST(Proximity, IsThatOfTheNearestPoints) {
  RandomPoints points(1);
  for (const PairKind kind : kinds)
    for (int k = 0; k < 10000; ++k)
      expect_nearest(kind, {points.anywhere(), points.anywhere(), points.anywhere(), points.anywhere()}, 1e-12);
}

TEST(Proximity, ToleratesCornersThatCoincideAndParallelEdges) {
  RandomPoints points(2);
  for (const PairKind kind : kinds)
    for (int k = 0; k < 10000; ++k)
      expect_nearest(kind, {points.on_lattice(), points.on_lattice(), points.on_lattice(), points.on_lattice()}, 1e-12);
}

TEST(Proximity, ToleratesWhatIsNearlyDegenerate) {
  RandomPoints points(3);
  for (const PairKind kind : kinds)
    for (const double size : {1e-3, 1e-6, 1e-9, 1e-12})
      for (int k = 0; k < 2000; ++k) {
        FourPoints x;
        for (Vector3d& p : x) p = points.on_lattice() + size * points.anywhere();
        expect_nearest(kind, x, 1e-7);
      }
}

TEST(Proximity, IsNotFartherThanAnySample) {
  RandomPoints points(4);
  constexpr int cells = 12;
  for (int k = 0; k < 300; ++k) {
    const FourPoints x{points.anywhere(), points.anywhere(), points.anywhere(), points.anywhere()};
    double vertex_face = HUGE_VAL, edge_edge = HUGE_VAL;
    for (int a = 0; a <= cells; ++a)
      for (int b = 0; b <= cells; ++b) {
        const double s = a / double(cells), t = b / double(cells);
        edge_edge = std::min(edge_edge, (x[0] + s * (x[1] - x[0]) - x[2] - t * (x[3] - x[2])).norm());
        if (a + b <= cells) vertex_face = std::min(vertex_face, (x[0] - (1 - s - t) * x[1] - s * x[2] - t * x[3]).norm());
      }
    for (const auto& [kind, sampled] :
         {std::pair(PairKind::vertex_face, vertex_face), std::pair(PairKind::edge_edge, edge_edge)}) {
      const double distance = model::proximity(kind, x).distance;
      EXPECT_LE(distance, sampled);
      EXPECT_GE(distance, sampled - 2 * std::sqrt(12.0) / cells) << "half of the longest edge's cell from each";
    }
  }
}

TEST(Proximity, OfAVertexIsThatOfNearestOnTriangle) {
  RandomPoints points(5);
  for (int k = 0; k < 10000; ++k) {
    const Vector3d p = points.anywhere();
    const Corners corners{points.anywhere(), points.anywhere(), points.anywhere()};
    const double expected = (p - model::nearest_on_triangle(corners, p).point).norm();
    EXPECT_NEAR(model::proximity(PairKind::vertex_face, {p, corners[0], corners[1], corners[2]}).distance, expected, 1e-12);
  }
}

/// Up to its sign.
void expect_normal(PairKind kind, const FourPoints& x, const Vector3d& expected) {
  EXPECT_NEAR(std::abs(model::proximity(kind, x).normal.dot(expected)), 1, 1e-12);
  EXPECT_LT(model::proximity(kind, x).distance, 1e-15);
}

TEST(Proximity, HasANormalWherePairsTouch) {
  const Vector3d o = Vector3d::Zero(), ex = Vector3d::UnitX(), ey = Vector3d::UnitY(), ez = Vector3d::UnitZ();
  expect_normal(PairKind::vertex_face, {0.2 * ex + 0.2 * ey, o, ex, ey}, ez);
  expect_normal(PairKind::vertex_face, {o, o, ex, ey}, ez);
  expect_normal(PairKind::edge_edge, {-ex, ex, -ey, ey}, ez);
  const double perpendicular = model::proximity(PairKind::edge_edge, {-ex, ex, o, 2 * ex}).normal.dot(ex);
  EXPECT_NEAR(perpendicular, 0, 1e-15);
  EXPECT_NEAR(model::proximity(PairKind::vertex_face, {ex, o, ex, 2 * ex}).normal.dot(ex), 0, 1e-15);
  EXPECT_EQ(model::proximity(PairKind::vertex_face, {o, o, o, o}).normal.norm(), 1);
}

TEST(Proximity, IsInsideWhereNothingEnds) {
  const Vector3d o = Vector3d::Zero(), ex = Vector3d::UnitX(), ey = Vector3d::UnitY(), ez = Vector3d::UnitZ();
  EXPECT_TRUE(model::proximity(PairKind::edge_edge, {-ex, ex, ez - ey, ez + ey}).is_inside());
  EXPECT_FALSE(model::proximity(PairKind::edge_edge, {-ex, ex, ez, ez + ey}).is_inside());
  EXPECT_TRUE(model::proximity(PairKind::vertex_face, {ez + 0.1 * ex + 0.1 * ey, o, ex, ey}).is_inside());
  EXPECT_FALSE(model::proximity(PairKind::vertex_face, {ez + ex, o, ex, ey}).is_inside());
}

// --- Triangles
// ----------------------------------------------------------------------------------------------------------------

/// On a lattice distances are 0 or far from it, so that round-off decides nothing.
TEST(CollisionTriangles, IntersectWhereTheirDistanceVanishes) {
  RandomPoints points(6);
  int intersecting = 0, apart = 0;
  for (int k = 0; k < 20000; ++k) {
    const Corners one{points.on_lattice(), points.on_lattice(), points.on_lattice()};
    const Corners other{points.on_lattice(), points.on_lattice(), points.on_lattice()};
    const auto has_area = [](const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]).norm() > 0.1; };
    const bool expected = has_area(one) && has_area(other) && model::nearer(one, other, 1e-9);
    EXPECT_EQ(model::intersect(one, other), expected);
    (expected ? intersecting : apart) += 1;
  }
  EXPECT_GT(intersecting, 3000);
  EXPECT_GT(apart, 3000);
}

TEST(CollisionTriangles, TouchInAVertex) {
  const Corners flat{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  // Dyadic, so that these are the places that are meant.
  const auto above = [](double z) { return Corners{Vector3d(0.25, 0.25, z), Vector3d(0, 0, 1), Vector3d(1, 0, 1)}; };
  EXPECT_TRUE(model::intersect(flat, above(0)));
  EXPECT_TRUE(model::intersect(flat, above(-1e-300)));
  EXPECT_FALSE(model::intersect(flat, above(1e-300)));
}

}  // namespace
}  // namespace drape::verify::proximity_test
