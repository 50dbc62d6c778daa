// The tables of a fabric: stresses of homogeneous strains from the published numbers, small strains against the linear law,
// bending, and Jacobians against differences.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/cloth.hpp"
#include "model/fabric.hpp"
#include "model/sheet/strain.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::tables_test {
namespace {

using namespace sheets;
using Eigen::Vector3d;
using model::StretchLaw;

Scene denim(const Grid& grid, StretchLaw law = StretchLaw::tables) {
  Scene scene;
  scene.sheet.grid = grid;
  scene.sheet.material = std::ranges::find(model::fabrics(), "denim", &model::Fabric::name)->material;
  scene.sheet.material.bend_projected = false;
  scene.sheet.material.law = law;
  return scene;
}

Vectors affine(const Grid& grid, const Vector3d& s_u, const Vector3d& s_v) {
  return grid.parameters().col(0) * s_u.transpose() + grid.parameters().col(1) * s_v.transpose();
}

/// What the right edge carries by width [N/m], along x and y.
Vector3d pull(const Scene& scene, const Vector3d& s_u, const Vector3d& s_v) {
  const Grid& grid = scene.sheet.grid;
  const Vectors x = affine(grid, s_u, s_v), f = evaluate(model::compile(scene).ode.force, {x, at_rest(x)});
  Vector3d sum = Vector3d::Zero();
  for (int b = 0; b < grid.nv; ++b) sum -= f.row(grid.index(grid.nu - 1, b));
  return sum / grid.size_v;
}

const Grid grid{4, 3, 0.3, 0.2};

/// Along the weft half way to a sixth: the mean of the first and the second row, twice.
TEST(Tables, GiveTheStressesThatArePublished) {
  const double stretch = 1 + 1.0 / 12, strain = (stretch * stretch - 1) / 2;
  const double C11 = 205.352005 + 232.027634;
  EXPECT_NEAR(pull(denim(grid), {stretch, 0, 0}, {0, 1, 0})[0], C11 * strain * stretch, 1e-9);
  EXPECT_NEAR(pull(denim(grid), {1, 0, 0}, {0, stretch, 0})[0], (10.234077 + 40.917892) * strain, 1e-9) << "C12";

  // By a sixth and more in the diagonal: the row of 45 degrees.
  for (const double most : {1 + 1.0 / 6, 1.25}) {
    const double e = (most * most - 1) / 4;  // ε11 = ε22 = ε12
    Eigen::Matrix2d U = Eigen::Matrix2d::Identity();
    U.array() += (most - 1) / 2;
    const Vector3d s_u(U(0, 0), U(1, 0), 0), s_v(U(0, 1), U(1, 1), 0);
    const Vector3d expected = 2 * (225.95105 + 62.095657) * e * s_u + 2 * 83.99202 * e / 2 * s_v;
    EXPECT_LT((pull(denim(grid), s_u, s_v) - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(Tables, AreTheModuliWhereStrainsAreSmall) {
  const Vectors flat = grid.parameters(), d = random_vectors(grid.particles(), 1, 5);
  double before = 0;
  for (const double size : {1e-5, 1e-6}) {
    const Vectors x = flat + size * spacing(grid) * d;
    const Vectors linear = evaluate(model::compile(denim(grid, StretchLaw::linear)).ode.force, {x, at_rest(x)});
    const Vectors table = evaluate(model::compile(denim(grid)).ode.force, {x, at_rest(x)});
    const double difference = (table - linear).norm() / linear.norm();
    EXPECT_LT(difference, before == 0 ? 1e-4 : 0.11 * before);
    before = difference;
  }
}

/// Bent about the warp with curvatures between those of the table: the moment is the work by angle.
TEST(Tables, BendWithTheStiffnessOfTheCurvature) {
  const Grid strip{5, 3, 0.04, 0.02};
  const model::Cloth cloth = model::compile(denim(strip));
  double area = 0;
  for (int a = 1; a < strip.nu - 1; ++a)
    for (int b = 0; b < strip.nv; ++b) area += strip.cell_areas()[strip.index(a, b)];
  const std::pair<double, double> expected[] = {
      {5, 0.5 * (6.4196457e-05 + 6.0286175e-05)}, {-15, 0.5 * (6.0286175e-05 + 6.0943428e-05)}, {60, 1.9824701e-05}};
  for (const auto& [kappa, B] : expected) {
    const double step = 1e-4;
    const Vectors by = (cylinder(strip, kappa + step) - cylinder(strip, kappa - step)) / (2 * step), x = cylinder(strip, kappa);
    const double moment = -evaluate(cloth.ode.force, {x, at_rest(x)}).cwiseProduct(by).sum() / area;
    EXPECT_NEAR(moment, B * kappa, 1e-6 * std::abs(B * kappa)) << kappa;
  }
}

/// Where explicit methods explode.
TEST(Tables, SurviveStatesThatAreNotFinite) {
  const SplitOde ode = model::compile(denim(grid)).ode;
  SparseMatrix dx, dv;
  for (const double size : {1e100, 1e200, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    const Vectors x = size * random_vectors(grid.particles(), 1, 7);
    EXPECT_FALSE(largest(evaluate(ode.force, {x, at_rest(grid.parameters())})) < 1e100);
    ode.jacobian(0, x, at_rest(grid.parameters()), dx, dv);
  }
}

TEST(Tables, TakeThePlaceOfModuliButNotOfDamping) {
  Scene scene = denim(grid);
  scene.sheet.material.shear_damping = 0.1;
  const model::Plan plan = model::compile(scene).plan;
  EXPECT_EQ(plan.terms, (std::vector<std::string>{"tables", "shear", "plate"}));
  EXPECT_EQ(plan.without_energy, std::vector<std::string>{"tables"});
}

}  // namespace
}  // namespace drape::verify::tables_test
