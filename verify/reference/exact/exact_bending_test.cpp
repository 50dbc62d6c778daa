// The bent strip: it fulfils its equation and end conditions, has the known limits and values, and is what the model's masses
// and springs come to with second order, both with the whole bending force and along the normal.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reference/exact/bending.hpp"
#include "reference/exact/polynomials.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/equilibrium.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::exact_bending_test {
namespace {

using reference::BendingForce;
using reference::BentSheet;
using reference::BentStrip;

class Bending : public testing::TestWithParam<BendingForce> {
 protected:
  /// So soft that differences of positions tell the tension.
  static BentSheet soft_sheet() { return sheet(0.05, 100); }
  static BentSheet sheet(double bend, double modulus = 1e6) { return {.modulus = modulus, .bend = bend, .force = GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(, Bending, testing::Values(BendingForce::whole, BendingForce::along_normal), [](const auto& test) {
  return std::string(test.param == BendingForce::whole ? "whole" : "along_normal");
});

/// Derivatives of the positions alone, by a polynomial through them on [begin, begin + length].
struct Fit {
  double length;
  Eigen::VectorXd X = reference::chebyshev(20);
  Eigen::MatrixXd D = reference::differentiation(X) / length;
  Eigen::MatrixX2d s, ds;

  Fit(const BentStrip& strip, double begin, double width) : length(width), s(X.size(), 2) {
    for (Eigen::Index i = 0; i < X.size(); ++i) s.row(i) = strip(begin + length * X[i]);
    ds = D * s;
  }
  Eigen::MatrixX2d tension(double k) const { return (k * (1 - 1 / ds.rowwise().norm().array())).matrix().asDiagonal() * ds; }
  Eigen::Vector2d normal(Eigen::Index i) const { return Eigen::Vector2d(-ds(i, 1), ds(i, 0)).normalized(); }
};

/// The bending force −B s'''' or what of −B s''' goes through a section, without its part along the tangent if it has none.
Eigen::Vector2d acting(const BentSheet& sheet, const Eigen::Vector2d& bending, const Eigen::Vector2d& N) {
  return sheet.force == BendingForce::whole ? bending : Eigen::Vector2d(N.dot(bending) * N);
}

TEST_P(Bending, IsInBalanceEverywhere) {
  const BentSheet s = soft_sheet();
  const BentStrip strip(s);
  for (const double begin : {0.2, 0.35, 0.5}) {
    const Fit fit(strip, begin, 0.3);
    const Eigen::MatrixX2d pull = fit.D * fit.tension(s.modulus), bending = -s.bend * fit.D * fit.D * fit.D * fit.ds;
    for (const int i : {8, 10, 12}) {
      const Eigen::Vector2d sum = pull.row(i).transpose() + acting(s, bending.row(i), fit.normal(i));
      EXPECT_LE((sum - Eigen::Vector2d(0, s.body_force)).norm(), 1e-6) << begin << ", " << i;
    }
  }
}

TEST_P(Bending, HasFreeMomentsAndAFreeEnd) {
  const BentSheet s = soft_sheet();
  const BentStrip strip(s);
  EXPECT_LE(strip(0).norm(), 1e-14);
  EXPECT_NEAR(strip(1)[1], 0, 1e-14);
  EXPECT_NEAR(strip.slope_curvature_tension(0)[1], 0, 1e-12);
  EXPECT_NEAR(strip.slope_curvature_tension(1)[1], 0, 1e-12);
  // The horizontal force through the section: at the end itself if there are no layers, else anywhere inside.
  const bool whole = s.force == BendingForce::whole;
  const Fit fit(strip, whole ? 0.5 : 0.7, 0.3);
  const Eigen::Index i = whole ? 10 : fit.X.size() - 1;
  const Eigen::Vector2d third = (fit.D * fit.D * fit.ds).row(i);
  const Eigen::Vector2d pull = fit.tension(s.modulus).row(i), shear = acting(s, -s.bend * third, fit.normal(i));
  EXPECT_GE(std::abs(pull[0]), 1e-2);
  EXPECT_NEAR(pull[0] + shear[0], 0, 1e-6);
}

TEST_P(Bending, SlopeCurvatureAndTensionAreThoseOfThePositions) {
  const BentSheet s = soft_sheet();
  const BentStrip strip(s);
  const Fit fit(strip, 0.1, 0.3);
  for (const int i : {8, 10, 12}) {
    const Eigen::Vector3d given = strip.slope_curvature_tension(0.1 + 0.3 * fit.X[i]);
    const Eigen::Vector2d ds = fit.ds.row(i), dds = (fit.D * fit.ds).row(i);
    EXPECT_NEAR(given[0], std::atan2(ds[1], ds[0]), 1e-9);
    EXPECT_NEAR(given[1], (ds[0] * dds[1] - ds[1] * dds[0]) / ds.squaredNorm(), 1e-7);
    EXPECT_NEAR(given[2], s.modulus * (ds.norm() - 1), 1e-7);
  }
}

TEST_P(Bending, IsTheMirrorImageOfItself) {
  const BentStrip strip(sheet(0.01));
  for (const double X : {0.05, 0.2, 0.4}) {
    const Eigen::Vector2d a = strip(X), b = strip(1 - X);
    EXPECT_NEAR(a[0] + b[0], strip(1)[0], 1e-11);
    EXPECT_NEAR(a[1], b[1], 1e-11);
  }
}

TEST_P(Bending, ErrorIsBelow1em11) {
  DRAPE_SLOW();
  for (const double bend : {5.0, 0.01, 0.005}) EXPECT_LE(BentStrip(sheet(bend)).error(), 1e-11) << bend;
  EXPECT_GT(BentStrip(sheet(0.005)).error(), 1e-15);  // it is an estimate, not a constant
}

/// z = −(f/24B)(X − 2X³ + X⁴) up to the third power of the deflection.
TEST_P(Bending, OfStiffStripsIsThatOfTheLinearBeam) {
  Convergence c;
  for (const double B : {1.0, 2.0, 4.0, 8.0}) {
    c.steps.push_back(1 / B);
    c.errors.push_back(std::abs(BentStrip(sheet(B, 1e9))(0.5)[1] + 5 / (384 * B)));
  }
  EXPECT_TRUE(has_order(c, 3));
}

TEST(BendingForms, DifferAtLargeDeflections) {
  const auto free_end = [](double bend, BendingForce force) { return BentStrip({.bend = bend, .force = force})(1)[0]; };
  EXPECT_NEAR(free_end(0.01, BendingForce::along_normal), 0.672, 5e-4);
  EXPECT_NEAR(free_end(0.01, BendingForce::whole), 0.557, 5e-4);
  EXPECT_NEAR(free_end(5, BendingForce::along_normal), free_end(5, BendingForce::whole), 1e-8);
}

model::Scene scene_of(const BentSheet& sheet, int n) {
  model::Scene scene;
  scene.sheet.grid = {n, 2, 1, 1.0 / (n - 1)};
  model::Material& m = scene.sheet.material;
  m.tension = {sheet.modulus, sheet.modulus};
  m.bend = {sheet.bend, sheet.bend};
  m.bend_projected = sheet.force == BendingForce::along_normal;
  scene.sheet.gravity[2] = -sheet.body_force;
  scene.pins = {{.where = "left edge", .particles = {}},
                {.where = "right edge", .particles = {}, .directions = {false, false, true}},
                {.where = "all", .particles = {}, .directions = {false, true, false}}};
  return scene;
}

/// L2 errors of the model's equilibria on grids of n nodes.
Convergence errors(const BentSheet& sheet, const std::vector<int>& grids) {
  const BentStrip strip(sheet);
  Convergence c;
  for (const int n : grids) {
    const model::Scene scene = scene_of(sheet, n);
    solver::Vectors exact = scene.sheet.grid.parameters();
    for (auto row : exact.rowwise()) {
      const Eigen::Vector2d s = strip(row[0]);
      row[0] = s[0];
      row[2] = s[1];
    }
    c.steps.push_back(1.0 / (n - 1));
    c.errors.push_back(rms_distance(scene.sheet.grid, equilibrium(scene, exact), exact));
  }
  return c;
}

TEST_P(Bending, MassesAndSpringsComeToItWithSecondOrder) {
  DRAPE_SLOW();
  EXPECT_TRUE(has_order(errors(sheet(5), {5, 9, 17, 33}), 2));
}

TEST_P(Bending, MassesAndSpringsComeToLargeDeflectionsWithSecondOrder) {
  DRAPE_SLOW();
  EXPECT_TRUE(has_order(errors(sheet(0.01), {17, 33, 65, 129}), 2));
  EXPECT_TRUE(has_order(errors(sheet(0.005), {17, 33, 65, 129}), 2));
}

}  // namespace
}  // namespace drape::verify::exact_bending_test
