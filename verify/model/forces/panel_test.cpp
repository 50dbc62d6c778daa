// Forces on curved panels: what they share with those of rectangles, and an exact equilibrium.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/linear/conjugate_gradients.hpp"
#include "solver/linear/preconditioner.hpp"
#include "solver/linear/stage_matrix.hpp"
#include "solver/methods/projection.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/equilibrium.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/panels.hpp"

namespace drape::verify::panel_test {
namespace {

using namespace sheets;

constexpr double rounding = 1000 * std::numeric_limits<double>::epsilon();

/// The rectangle of a grid as an outline.
Grid outlined(Grid grid) {
  grid.outline = model::parallelogram({grid.size_u, 0}, {0, grid.size_v});
  return grid;
}

/// One to several blocks of columns.
TEST(Panels, WithFourStraightSidesAreRectangles) {
  for (const Grid& grid : {five_by_four(), Grid{137, 3, 13.7, 0.3}, Grid{3, 130, 0.3, 13}})
    for (const ForceCase& force : force_cases()) {
      const Grid panel = outlined(grid);
      if (!exists_on(panel, force)) continue;
      const SplitOde expected = ode_of(force, grid), ode = ode_of(force, panel);
      const State y = deformed(grid, 1);
      const Vectors f = evaluate(expected.force, y), rest = evaluate(expected.explicit_force, y);
      EXPECT_LE(largest(evaluate(ode.force, y) - f), 10 * rounding * largest(f)) << force.name;
      EXPECT_LE(largest(evaluate(ode.explicit_force, y) - rest), 10 * rounding * largest(rest)) << force.name;
      const double energy = expected.potential_energy(0, y.x);
      EXPECT_NEAR(ode.potential_energy(0, y.x), energy, 1e-10 * (1 + std::abs(energy))) << force.name;
      EXPECT_LE(largest(ode.mass - expected.mass), rounding * largest(expected.mass));
    }
}

/// However it lies: no elastic force acts, and there is no energy.
TEST(Panels, RestAsTheirPatternsAre) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  for (const Grid& grid : {graded(), curved(), panels::sector(6)})
    for (const ForceCase& force : force_cases()) {
      if (!exists_on(grid, force) || !force.gravity.isZero() || force.wind.blows()) continue;
      const SplitOde ode = ode_of(force, grid);
      const Vectors x = grid.parameters() * turn.transpose();
      EXPECT_LE(largest(evaluate(ode.force, {x, at_rest(x)})), rounding * largest(evaluate(ode.force, deformed(grid, 1))))
          << force.name;
      EXPECT_LE(std::abs(ode.potential_energy(0, x)), rounding) << force.name;
    }
}

TEST(Panels, HaveForgottenNothingAtRest) {
  for (const Grid& grid : {graded(), curved()}) {
    Scene scene;
    scene.sheet.grid = grid;
    scene.sheet.material = made_of(tension, shear);
    scene.sheet.material.relaxation.maxwell = {{1, 0.3}, {10, 0.4}};
    const model::Cloth cloth = model::compile(scene);
    const Vectors x = grid.parameters();
    Vectors f;
    cloth.ode.force(0.1, x, at_rest(x), f);  // at the end of a path, on which elements have begun to relax
    EXPECT_LE(largest(f), rounding);
  }
}

/// What methods need that move positions.
TEST(Panels, HaveCompliantConstraintsWithTheSameForces) {
  const Grid grid = curved();
  const SplitOde ode = ode_of({.name = "both",
                               .material = made_of(tension, shear),
                               .has_energy = true,
                               .keeps_momentum = true,
                               .keeps_angular = true,
                               .dissipates = true,
                               .ignores_rotation = true,
                               .exists_on_chains = false},
                              grid);
  const State y = deformed(grid, 1);
  Vectors f = evaluate(ode.unconstrained_force, y);
  solver::add_forces(ode.compliant_constraints(), y.x, f);
  const Vectors whole = evaluate(ode.force, y);
  EXPECT_LE(largest(f - whole), rounding * largest(whole));
}

/// An annulus whose inner border is held and whose outer one is pulled outwards by s, of threads along the radius and along the
/// circles: E = ½ ∫ (k1 (r' − 1)² + k2 (r/R − 1)²) R dR has for r = R + u the equation (R u')' = μ² u/R with μ² = k2/k1,
/// however large the strains are: u is a sum of R^μ and R^−μ.
TEST(Panels, PulledAlongTheRadiusConvergeToTheExactEquilibriumWithOrderTwo) {
  constexpr double k1 = 80, k2 = 200, pulled = 0.1, inner = panels::inner, outer = panels::outer;
  const double mu = std::sqrt(k2 / k1);
  const double scale = pulled / (std::pow(outer / inner, mu) - std::pow(outer / inner, -mu));
  const auto exact = [&](double R) { return R + scale * (std::pow(R / inner, mu) - std::pow(R / inner, -mu)); };
  Convergence c;
  for (const int n : {9, 17, 33, 65}) {
    Scene scene;
    scene.sheet.grid = panels::sector(n);
    scene.sheet.material.tension = {k1, k2};
    scene.pins = {{.where = "left edge", .particles = {}},
                  {.where = "right edge", .particles = {}},
                  {.where = "lower edge", .particles = {}, .directions = {false, true, false}},
                  {.where = "upper edge", .particles = {}, .directions = {true, false, false}}};
    const Vectors pattern = scene.sheet.grid.parameters();
    Vectors expected = pattern, guess = pattern;
    for (int i = 0; i < pattern.rows(); ++i) {
      const double R = pattern.row(i).norm();
      expected.row(i) *= exact(R) / R;
      guess.row(i) *= (R + pulled * (R - inner) / (outer - inner)) / R;
    }
    c.steps.push_back(1.0 / (n - 1));
    c.errors.push_back(rms_distance(scene.sheet.grid, equilibrium(scene, guess), expected));
  }
  EXPECT_TRUE(has_order(c, 2));
  EXPECT_LE(c.errors.back(), 1e-3 * pulled);
}

/// Spacings along the circles grow outwards, so that coefficients differ from place to place.
TEST(Panels, AreSolvedByMultigridInIterationsThatDoNotGrowWithThem) {
  constexpr int most = 18;  // rectangles take up to 12
  for (const int n : {33, 65, 129}) {
    Scene scene;
    scene.sheet.grid = panels::sector(n);
    scene.sheet.material.tension = {500, 500};
    const SparseMatrix A = solver::stage_matrix(model::compile(scene).ode, 0.01);
    ASSERT_TRUE(solver::five_point(A));
    solver::Counters work;
    solver::ConjugateGradients cg(solver::make_multigrid(), 100, work);
    cg.analyse(A);
    ASSERT_EQ(cg.factor(A), solver::Outcome::success);
    const Vectors b = random_vectors(static_cast<int>(A.rows()), 1, 1);
    Vectors r = b, x = Vectors::Zero(b.rows(), 3);
    const solver::LinearResult result = cg.solve(A, {}, r, x, 1e-8 * b.norm());
    EXPECT_EQ(result.outcome, solver::Outcome::success);

    EXPECT_LE(result.iterations, most) << n;
    EXPECT_LE((b - A * x).norm(), 1.1e-8 * b.norm());
  }
}

}  // namespace
}  // namespace drape::verify::panel_test
