// Curves by their arc length, graded places and points inside four sides.

#include "model/sheet/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drape::verify::outline_test {
namespace {

using Eigen::Vector2d;
using model::Curve;
using enum model::CurvePiece::Kind;

constexpr double rounding = 1e-13;

void expect_near(const Vector2d& point, const Vector2d& expected, double within = rounding) {
  EXPECT_LE((point - expected).norm(), within) << point.transpose() << " instead of " << expected.transpose();
}

TEST(Curve, GoesAlongLinesAndArcsByTheirLengths) {
  const Curve straight({{line, {{1, 2}, {4, 6}}}});
  EXPECT_EQ(straight.length(), 5);
  expect_near(straight.at(0.25), {1.75, 3});
  const Curve quarter({{arc, {{2, 0}, {std::numbers::sqrt2, std::numbers::sqrt2}, {0, 2}}}});
  EXPECT_NEAR(quarter.length(), std::numbers::pi, rounding);
  expect_near(quarter.at(1.0 / 3), {std::sqrt(3), 1});
  const Curve clockwise({{arc, {{0, 2}, {std::numbers::sqrt2, std::numbers::sqrt2}, {2, 0}}}});
  expect_near(clockwise.at(1.0 / 3), {1, std::sqrt(3)});
  const double c = std::numbers::sqrt2 / 2;
  const Curve up_on_the_left({{arc, {{-c, -c}, {-1, 0}, {-c, c}}}});
  EXPECT_NEAR(up_on_the_left.length(), std::numbers::pi / 2, rounding);
  expect_near(up_on_the_left.at(0.5), {-1, 0});
  const Curve most_of_a_circle({{arc, {{1, 0}, {-1, 0}, {0, -1}}}});
  EXPECT_NEAR(most_of_a_circle.length(), 1.5 * std::numbers::pi, rounding);
  expect_near(most_of_a_circle.at(1.0 / 3), {0, 1});
}

TEST(Curve, GoesAlongPolylinesByTheirLengths) {
  const Curve bent({{polyline, {{0, 0}, {3, 0}, {3, 4}, {4, 4}}}});
  EXPECT_EQ(bent.length(), 8);
  expect_near(bent.at(0.25), {2, 0});
  expect_near(bent.at(0.375), {3, 0});
  expect_near(bent.at(0.625), {3, 2});
  expect_near(bent.at(1), {4, 4});
}

/// Both parts are the whole curve again.
TEST(Curve, CanBeDividedAnywhere) {
  const double c = std::numbers::sqrt2;
  for (const model::CurvePiece& piece : {model::CurvePiece{line, {{1, 2}, {4, 6}}},
                                         {arc, {{2, 0}, {c, c}, {0, 2}}},
                                         {bezier, {{0, 0}, {0.75, 0}, {1.5, 2.25}}},
                                         {bezier, {{0, 0}, {1, 2}, {2, -1}, {3, 1}}},
                                         {polyline, {{0, 0}, {3, 0}, {3, 4}, {4, 4}}}})
    for (const double part : {0.2, 0.6, 0.95}) {
      const auto [first, second] = model::divided(piece, part);
      const Curve whole({piece}), one({first}), other({second});
      EXPECT_EQ(first.kind, piece.kind);
      EXPECT_NEAR(one.length(), part * whole.length(), 1e-11);
      EXPECT_NEAR(other.length(), (1 - part) * whole.length(), 1e-11);
      for (const double along : {0.0, 0.3, 0.8, 1.0}) {
        expect_near(one.at(along), whole.at(part * along), 1e-11);
        expect_near(other.at(along), whole.at(part + (1 - part) * along), 1e-11);
      }
    }
}

/// The parabola y = x² has the length (2x √(1 + 4x²) + asinh 2x)/4 from its vertex.
TEST(Curve, GoesAlongBezierCurvesByTheirLengths) {
  const auto length = [](double x) { return (2 * x * std::sqrt(1 + 4 * x * x) + std::asinh(2 * x)) / 4; };
  const Curve parabola({{bezier, {{0, 0}, {0.75, 0}, {1.5, 2.25}}}});
  EXPECT_NEAR(parabola.length(), length(1.5), rounding);
  for (const double part : {0.0, 0.001, 0.1, 1.0 / 3, 0.5, 0.99, 1.0}) {
    const Vector2d point = parabola.at(part);
    EXPECT_NEAR(point.y(), point.x() * point.x(), rounding);
    EXPECT_NEAR(length(point.x()), part * length(1.5), rounding) << part;
  }
}

/// Its beginning has no speed: (t³, t²).
TEST(Curve, GoesAlongBezierCurvesWithACusp) {
  const auto length = [](double t) { return (std::pow(4 + 9 * t * t, 1.5) - 8) / 27; };
  const Curve cusp({{bezier, {{0, 0}, {0, 0}, {0, 1.0 / 3}, {1, 1}}}});
  EXPECT_NEAR(cusp.length(), length(1), 1e-9);
  for (const double part : {1e-6, 0.01, 0.5}) {
    const Vector2d point = cusp.at(part);
    EXPECT_NEAR(length(std::sqrt(point.y())), part * length(1), 1e-9) << part;
  }
}

TEST(Curve, GoesFromPieceToPiece) {
  const Curve curve({{line, {{0, 0}, {1, 0}}}, {arc, {{1, 0}, {2, 1}, {1, 2}}}, {line, {{1, 2}, {0, 2}}}});
  const double whole = 2 + std::numbers::pi;
  EXPECT_NEAR(curve.length(), whole, rounding);
  expect_near(curve.at(0), {0, 0});
  expect_near(curve.at(1 / whole), {1, 0});
  expect_near(curve.at(0.5), {2, 1});
  expect_near(curve.at((1 + std::numbers::pi) / whole), {1, 2});
  expect_near(curve.at(1), {0, 2});
}

TEST(Graded, SpacingsGrowByAConstantFactor) {
  const std::vector<double> places = model::graded(6, 8);
  EXPECT_EQ(places.front(), 0);
  EXPECT_EQ(places.back(), 1);
  const auto spacing = [&](int k) { return places[k + 1] - places[k]; };
  EXPECT_NEAR(spacing(4) / spacing(0), 8, rounding);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(spacing(k + 1) / spacing(k), std::pow(8, 0.25), rounding);
  EXPECT_EQ(model::graded(5, 1), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(model::graded(2, 8), (std::vector<double>{0, 1}));
}

/// A straight quadrilateral is bilinear, and a sector of an annulus has circles and rays for lines.
TEST(Transfinite, FillsQuadrilateralsAndSectors) {
  const Vector2d p00(0, 0), p10(2, 0.5), p01(0.3, 1), p11(1.5, 2);
  const model::Outline straight{.lower = {{line, {p00, p10}}},
                                .upper = {{line, {p01, p11}}},
                                .left = {{line, {p00, p01}}},
                                .right = {{line, {p10, p11}}}};
  const std::vector<double> u = model::graded(4, 2), v = model::graded(3, 0.5);
  const auto inside = transfinite(straight, u, v);
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 4; ++a) {
      const double s = u[a], t = v[b];
      expect_near(inside.row(a + 4 * b).head<2>(),
                  (1 - s) * (1 - t) * p00 + s * (1 - t) * p10 + (1 - s) * t * p01 + s * t * p11);
    }

  const double c = std::numbers::sqrt2 / 2, r = 0.2, R = 0.5;
  const model::Outline sector{.lower = {{line, {{r, 0}, {R, 0}}}},
                              .upper = {{line, {{0, r}, {0, R}}}},
                              .left = {{arc, {{r, 0}, {r * c, r * c}, {0, r}}}},
                              .right = {{arc, {{R, 0}, {R * c, R * c}, {0, R}}}}};
  const auto polar = transfinite(sector, u, v);
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 4; ++a) {
      const double radius = r + (R - r) * u[a], angle = v[b] * std::numbers::pi / 2;
      expect_near(polar.row(a + 4 * b).head<2>(), radius * Vector2d(std::cos(angle), std::sin(angle)));
    }
}

/// Particles are where pieces end, and lines between them are straight on the unit square.
TEST(Transfinite, HasTheCellsThatPiecesCount) {
  const model::Outline square{.lower = {{line, {{0, 0}, {0.3, 0}}, 2}, {line, {{0.3, 0}, {1, 0}}, 1}},
                              .upper = {{line, {{0, 1}, {1, 1}}}},
                              .left = {{line, {{0, 0}, {0, 0.9}}, 1}, {line, {{0, 0.9}, {0, 1}}, 2}},
                              .right = {{line, {{1, 0}, {1, 1}}}}};
  const auto inside = transfinite(square, model::graded(4, 1), model::graded(4, 1));
  expect_near(inside.row(1).head<2>(), {0.15, 0});
  expect_near(inside.row(2).head<2>(), {0.3, 0});
  expect_near(inside.row(4).head<2>(), {0, 0.9});
  expect_near(inside.row(8).head<2>(), {0, 0.95});
  const auto cross = [](double x, double y) {
    return 0.15 + y * (1.0 / 3 - 0.15) - x;
  };  // on the line between (0.15, 0) and (1/3, 1)
  for (const int b : {1, 2}) EXPECT_NEAR(cross(inside(1 + 4 * b, 0), inside(1 + 4 * b, 1)), 0, rounding);
  EXPECT_NEAR(0.9 + inside(5, 0) * (1.0 / 3 - 0.9), inside(5, 1), rounding);
}

}  // namespace
}  // namespace drape::verify::outline_test
