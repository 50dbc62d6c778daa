// Where forces have no error of discretisation at all: planes, homogeneous strains, polynomials, and a sheet pulled from one
// edge.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference/exact/tension.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::force_exact_test {
namespace {

using namespace sheets;
using Eigen::Vector3d;
using testing::TestWithParam;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The field x = origin + u s_u + v s_v.
Vectors affine(const Grid& grid, const Vector3d& s_u, const Vector3d& s_v) {
  const Vectors uv = grid.parameters();
  return (uv.col(0) * s_u.transpose() + uv.col(1) * s_v.transpose()).rowwise() + Eigen::RowVector3d(0.3, 0.1, -0.2);
}
const Vector3d s_u(1.1, 0.2, 0.1), s_v(0.3, 0.9, -0.2);

TEST(ExactForces, BendingForcesOfPlanesAreZero) {
  for (const auto& [name, grid] : grids())
    for (const std::string bend : {"membrane", "plate", "unprojected_plate"}) {
      if (!exists_on(grid, force_case(bend))) continue;
      const SplitOde ode = ode_of(force_case(bend), grid);
      const double size = largest(evaluate(ode.force, deformed(grid, 1)));
      const Vectors x = affine(grid, s_u, s_v);
      EXPECT_LE(largest(evaluate(ode.force, {x, at_rest(x)})), 1000 * epsilon * size) << bend << " on " << name;
    }
}

/// The patch test, on a square, and on a parallelogram with spacings that grow.
TEST(ExactForces, HomogeneousStrainsHaveNoForceInside) {
  Grid sheared{8, 7, 1.4, 1.1};
  sheared.outline = model::parallelogram({1, 0.2}, {0.4, 0.9});
  sheared.grading_u = 3, sheared.grading_v = 0.5;
  for (const Grid& grid : {Grid{8, 7, 1, 1}, sheared})
    for (const ForceCase& force : force_cases()) {
      if (!force.gravity.isZero() || force.wind.blows() || !exists_on(grid, force)) continue;
      const Vectors x = affine(grid, s_u, s_v);
      const Vectors f = evaluate(ode_of(force, grid).force, {x, at_rest(x)});
      for (int b = 2; b < grid.nv - 2; ++b)
        for (int a = 2; a < grid.nu - 2; ++a)
          EXPECT_LE(largest(f.row(grid.index(a, b))), 1000 * epsilon * (1 + largest(f))) << force.name << a << b;
    }
}

TEST(ExactForces, EnergiesOfHomogeneousStrainsAreDensityTimesArea) {
  const Material m = made_of(tension, shear, contraction);
  const double e11 = s_u.norm() - 1, e22 = s_v.norm() - 1, gamma = s_u.dot(s_v);
  const std::pair<std::string, double> expected[] = {
      {"tension", 0.5 * (m.tension.weft * e11 * e11 + m.tension.warp * e22 * e22)},
      {"shear", 0.5 * m.shear * gamma * gamma},
      {"contraction", m.contraction * e11 * e22}};
  for (const auto& [name, grid] : grids())
    for (const auto& [force, density] : expected) {
      if (is_chain(grid) || grid.outline.given() || grid.is_cut()) continue;
      const double exact = density * grid.size_u * grid.size_v;
      EXPECT_NEAR(ode_of(force_case(force), grid).potential_energy(0, affine(grid, s_u, s_v)), exact,
                  1000 * epsilon * std::abs(exact))
          << force << " on " << name;
    }
}

/// z = u^p v^q: central differences are exact up to fifth powers for ∂⁴ and up to third ones for ∂².
TEST(ExactForces, PlateForcesOfPolynomialsInside) {
  const Grid grid{9, 8, 1, 1};
  const SplitOde ode = ode_of(force_case("unprojected_plate"), grid);
  const auto [B1, B2] = force_case("unprojected_plate").material.bend;
  const auto power = [](double u, int p, int order) {
    double factor = 1;
    for (int k = 0; k < order; ++k) factor *= p - k;
    return factor == 0 ? 0 : factor * std::pow(u, p - order);
  };
  for (const auto& [p, q] : {std::pair{4, 0}, {5, 0}, {0, 4}, {0, 5}, {2, 2}, {3, 2}, {3, 3}, {4, 1}, {1, 5}, {3, 1}}) {
    Vectors x = grid.parameters();
    x.col(2) = x.col(0).array().pow(p) * x.col(1).array().pow(q);
    const Vectors f = evaluate(ode.force, {x, at_rest(x)});
    for (int b = 2; b < grid.nv - 2; ++b)
      for (int a = 2; a < grid.nu - 2; ++a) {
        const double u = a * grid.spacing_u(), v = b * grid.spacing_v();
        const double exact = -B1 * power(u, p, 4) * power(v, q, 0) - (B1 + B2) * power(u, p, 2) * power(v, q, 2) -
                             B2 * power(u, p, 0) * power(v, q, 4);
        const double rounding = 1000 * epsilon * (B1 + B2) / std::pow(spacing(grid), 4);
        EXPECT_NEAR(f(grid.index(a, b), 2) / grid.cell_areas()[grid.index(a, b)], exact, rounding) << "u^" << p << " v^" << q;
      }
  }
}

/// z = c1 u² + c2 v² has constant curvatures, which a border particle takes from its inner neighbour.
TEST(ExactForces, MembraneForcesOfConstantCurvatureOnBordersToo) {
  const Grid grid{6, 5, 1, 0.6};
  const auto [B1, B2] = force_case("membrane").material.bend;
  Vectors x = grid.parameters();
  const double c1 = 1e-7, c2 = 2e-7;  // so flat that its normals are vertical up to rounding: the linear theory
  x.col(2) = c1 * x.col(0).array().square() + c2 * x.col(1).array().square();
  const Vectors f = evaluate(ode_of(force_case("membrane"), grid).force, {x, at_rest(x)});
  const double exact = 2 * (B1 * c1 + B2 * c2);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a)
      EXPECT_NEAR(f(grid.index(a, b), 2) / grid.cell_areas()[grid.index(a, b)], exact, 1e-9 * exact) << a << ", " << b;
}

/// Experiment (a) of figure 2.11 in all four directions: the exact solution is in equilibrium at all nodes but the fixed.
struct Pull {
  std::string fixed;
  bool along_v, from_end;
};

class PulledFrom : public TestWithParam<Pull> {};
INSTANTIATE_TEST_SUITE_P(, PulledFrom,
                         testing::Values(Pull{"left", false, false}, Pull{"right", false, true}, Pull{"lower", true, false},
                                         Pull{"upper", true, true}),
                         [](const auto& test) { return test.param.fixed; });

TEST_P(PulledFrom, HasItsExactSolutionAtTheNodes) {
  const auto [fixed, along_v, from_end] = GetParam();
  const reference::PulledSheet sheet{.length = 0.8, .modulus = 100, .body_force = 9.81};
  Scene scene;
  scene.sheet.material.density = 0.5;
  scene.sheet.material.tension = {sheet.modulus, sheet.modulus};
  scene.sheet.gravity[along_v] = (from_end ? -1 : 1) * sheet.body_force / scene.sheet.material.density;
  for (const int n : {2, 5, 20, 33}) {
    const Grid grid = along_v ? Grid{4, n, 0.5, sheet.length} : Grid{n, 4, sheet.length, 0.5};
    scene.sheet.grid = grid;
    Vectors x = grid.parameters();
    for (double& coordinate : x.col(along_v)) {
      const double X = from_end ? sheet.length - coordinate : coordinate, s = reference::pulled_position(sheet, X);
      coordinate = from_end ? sheet.length - s : s;
    }
    const Vectors f = evaluate(model::compile(scene).ode.force, {x, at_rest(x)});
    for (int b = 0; b < grid.nv; ++b)
      for (int a = 0; a < grid.nu; ++a) {
        if ((along_v ? b : a) == (from_end ? n - 1 : 0)) continue;
        EXPECT_LE(largest(f.row(grid.index(a, b))), 1e-10 * sheet.body_force * grid.cell_areas()[grid.index(a, b)])
            << n << ": " << a << ", " << b;
      }
  }
}

}  // namespace
}  // namespace drape::verify::force_exact_test
