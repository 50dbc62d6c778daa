// A stage that is called solved is solved: the residual is computed again from the forces. Work is done only where it is
// needed.

#include "solver/stage/stage_solver.hpp"

#include <gtest/gtest.h>

#include "verify/support/small_problems.hpp"

namespace drape::verify::stage_solver_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::Stage;
using solver::StageResult;
using solver::StageSolver;

constexpr double gamma = 0.04, t = start_time + gamma;

/// An implicit Euler step from the start of a problem, with a bad guess.
struct Case {
  Problem problem;
  Options options = tight();
  Vectors ax = problem.start.x, av = problem.start.v;
  State y{ax, 3 * noise(particles, 21)};

  std::int64_t count(const char* kind) const { return problem.ode.work->count(kind); }

  Stage stage() const { return {gamma, t, ax, av}; }
  StageResult solve() { return StageSolver(problem.ode, options).solve(stage(), y); }
  StageResult solve_linear(const Vectors& f) { return StageSolver(problem.ode, options).solve_linear(stage(), f, y); }

  /// |M av + γ f(t, x, v) − M v| over the free coordinates, with the whole force or with the given explicit part.
  double residual(const Vectors& f) const {
    Vectors r = problem.ode.mass.asDiagonal() * (av - y.v) + gamma * f;
    filter(problem.ode.pins, r);
    return r.norm();
  }
  double residual() const {
    Vectors f(particles, 3);
    problem.ode.force(t, y.x, y.v, f);
    return residual(f);
  }
  double residual_with(const Vectors& f_explicit) const {
    return residual(problem.ode.stiffness * y.x + problem.ode.damping * y.v + f_explicit);
  }
  /// |b| = |M av + γ (K ax + f_expl)| over the free coordinates, at the present state.
  double right_hand_side() const {
    Vectors f(particles, 3);
    problem.ode.explicit_force(t, ax + gamma * y.v, y.v, f);
    Vectors b = problem.ode.mass.asDiagonal() * av + gamma * (problem.ode.stiffness * ax + f);
    filter(problem.ode.pins, b);
    return b.norm();
  }
};

class StageOf : public testing::TestWithParam<std::string> {
 protected:
  Case stage_case{problem_named(GetParam())};
};
INSTANTIATE_TEST_SUITE_P(, StageOf, testing::ValuesIn(names(problems())), [](const auto& test) { return test.param; });

TEST_P(StageOf, IsSolvedByTheLoop) {
  for (const auto& kind : solver::linear_solvers()) {
    Case c = stage_case;
    c.options.linear_solver = &kind;
    ASSERT_EQ(c.solve().outcome, Outcome::success);
    EXPECT_LE(c.residual(), 1e-12) << kind.name;
    EXPECT_LE(largest(c.y.x - c.ax - gamma * c.y.v), 1e-15) << kind.name;
  }
}

TEST_P(StageOf, IsSolvedByOneLinearSystemIfTheExplicitPartIsGiven) {
  const Vectors f = 5 * noise(particles, 22);
  for (const auto& kind : solver::linear_solvers()) {
    Case c = stage_case;
    c.options.linear_solver = &kind;
    const StageResult result = c.solve_linear(f);
    ASSERT_EQ(result.outcome, Outcome::success);
    EXPECT_EQ(result.updates, 1);
    EXPECT_LE(c.residual_with(f), 1e-12) << kind.name;
    EXPECT_LE(largest(c.y.x - c.ax - gamma * c.y.v), 1e-15) << kind.name;
  }
}

TEST_P(StageOf, KeepsPinnedCoordinatesAtTheirVelocity) {
  Case c = stage_case;
  ASSERT_EQ(c.solve().outcome, Outcome::success);
  Vectors prescribed = c.y.v;
  prescribe(c.problem.ode.pins, prescribed);
  EXPECT_LE(largest(c.y.v - prescribed), 1e-15);
}

TEST(StageSolver, MeetsTheToleranceOfTheLoopBesideTheRightHandSide) {
  int updates_before = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    Case c{free_particles()};
    c.options = tolerances(tolerance, 1e-12);
    const double b = c.right_hand_side();
    const StageResult result = c.solve();
    ASSERT_EQ(result.outcome, Outcome::success);
    EXPECT_LE(c.residual(), tolerance * b * (1 + 1e-12)) << tolerance;
    EXPECT_GE(c.residual(), 1e-4 * tolerance * b) << "more work than asked for";
    EXPECT_GT(result.updates, updates_before) << tolerance;
    updates_before = result.updates;
  }
}

TEST(StageSolver, MeetsTheToleranceOfTheLinearSystem) {
  const Vectors f = 5 * noise(particles, 22);
  for (const double tolerance : {1e-1, 1e-3, 1e-9}) {
    Case c{free_particles()};
    c.options.cg_tolerance = tolerance;
    const Vectors b = c.problem.ode.mass.asDiagonal() * c.av + gamma * (c.problem.ode.stiffness * c.ax + f);
    ASSERT_EQ(c.solve_linear(f).outcome, Outcome::success);
    EXPECT_LE(c.residual_with(f), tolerance * b.norm() * (1 + 1e-9)) << tolerance;
  }
}

TEST(StageSolver, SolvesLinearSystemsNoLooserThanTheLoopNeeds) {
  Case c{free_particles()};
  c.options = tolerances(1e-9, 0.5);
  c.options.max_updates = 100;
  EXPECT_EQ(c.solve().outcome, Outcome::success);
}

TEST(StageSolver, TakesASolutionForAGuessWithoutAnyUpdate) {
  Case c{free_particles()};
  ASSERT_EQ(c.solve().outcome, Outcome::success);
  c.options.loop_tolerance = c.options.cg_tolerance = 1e-12;
  const State solution = c.y;
  const StageResult again = c.solve();
  EXPECT_EQ(again.outcome, Outcome::success);
  EXPECT_EQ(again.updates, 0);
  EXPECT_EQ(again.cg_iterations, 0);
  EXPECT_EQ(c.y.v, solution.v);
}

TEST(StageSolver, TestsTheGuessByTheToleranceOfTheLinearSolver) {
  Case c{free_particles()};
  ASSERT_EQ(c.solve().outcome, Outcome::success);
  c.y.v(2, 1) += 1e-6;  // good enough for the loop, but not for the linear solver
  c.options = tolerances(1e-3, 1e-9);
  ASSERT_LE(c.residual(), 1e-3 * c.right_hand_side());
  ASSERT_GE(c.residual(), 1e-9 * c.right_hand_side());
  const double before = c.residual();
  EXPECT_EQ(c.solve().updates, 1);
  EXPECT_LE(c.residual(), 0.1 * before);
}

TEST(StageSolver, GivesUpAfterTheAllowedUpdates) {
  Case c{free_particles()};
  c.options.max_updates = 3;
  const StageResult result = c.solve();
  EXPECT_EQ(result.outcome, Outcome::not_converged);
  EXPECT_EQ(result.updates, 3);
}

TEST(StageSolver, PassesOnThatConjugateGradientsFailed) {
  Case c{free_particles()};
  c.options.max_cg_iterations = 1;
  EXPECT_EQ(c.solve().outcome, Outcome::not_converged);
  EXPECT_EQ(c.solve_linear(c.ax).outcome, Outcome::not_converged);
}

TEST(StageSolver, BreaksDownOnAMatrixThatIsNotDefinite) {
  for (const auto& kind : solver::linear_solvers()) {
    Case c{free_particles()};
    c.options.linear_solver = &kind;
    c.problem.ode.stiffness *= -100;
    EXPECT_EQ(c.solve().outcome, Outcome::breakdown) << kind.name;
    EXPECT_EQ(c.solve_linear(c.ax).outcome, Outcome::breakdown) << kind.name;
  }
}

TEST(StageSolver, DoesNotTakeAMatrixThatBrokeDownForPrepared) {
  Case c{free_particles()};
  c.problem.ode.stiffness *= -100;
  StageSolver solver(c.problem.ode, c.options);
  EXPECT_EQ(solver.solve(c.stage(), c.y).outcome, Outcome::breakdown);
  EXPECT_EQ(solver.solve(c.stage(), c.y).outcome, Outcome::breakdown);
  EXPECT_EQ(c.count("factorisations"), 2);
}

TEST(StageSolver, SeesForcesThatAreNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Case c{free_particles()};
    c.problem.ode.force = [bad](double, const Vectors&, const Vectors&, Vectors& f) { f.setConstant(bad); };
    EXPECT_EQ(c.solve().outcome, Outcome::not_finite);
    EXPECT_EQ(c.solve_linear(Vectors::Constant(particles, 3, bad)).outcome, Outcome::not_finite);
  }
}

TEST(StageSolver, BuildsItsMatrixOnceForASize) {
  Case c{free_particles()};
  StageSolver solver(c.problem.ode, c.options);
  EXPECT_EQ(c.count("matrix_builds"), 0);
  for (int k = 0; k < 5; ++k) solver.solve(c.stage(), c.y);
  for (int k = 0; k < 5; ++k) solver.solve_linear(c.stage(), c.ax, c.y);
  EXPECT_EQ(c.count("matrix_builds"), 1);
  EXPECT_EQ(c.count("factorisations"), 1);
  solver.solve({gamma / 2, t, c.ax, c.av}, c.y);
  solver.solve(c.stage(), c.y);
  EXPECT_EQ(c.count("matrix_builds"), 3);
  EXPECT_EQ(c.count("factorisations"), 3);
}

TEST(StageSolver, HasNoEntriesForParticlesThatArePinnedInAllDirections) {
  const Case free{free_particles()}, pinned{pinned_particle()}, partly{partly_pinned()};
  for (const Case* c : {&free, &pinned, &partly}) StageSolver(c->problem.ode, c->options);
  const std::int64_t all = 2 * static_cast<std::int64_t>(std::size(springs)) + particles;
  EXPECT_EQ(free.count("matrix_entries"), all);
  EXPECT_EQ(pinned.count("matrix_entries"), all - 2 * 3);  // three springs end at particle 3
  EXPECT_EQ(partly.count("matrix_entries"), all);
}

TEST(StageSolver, CountsWhatItDid) {
  Case c{free_particles()};
  const StageResult result = c.solve();
  EXPECT_GT(result.updates, 3);
  EXPECT_EQ(c.count("updates"), result.updates);
  EXPECT_GT(result.cg_iterations, result.updates);
  EXPECT_EQ(c.count("cg_iterations"), result.cg_iterations);
  EXPECT_EQ(c.count("preconditioner_applications"), result.cg_iterations);
  EXPECT_EQ(c.count("matrix_products"), result.cg_iterations + 1);  // one for |b|
}

TEST(StageSolver, TakesAMotionThatDiedOutForNoBreakdown) {
  const SparseMatrix K = laplacian(&Spring::k);
  solver::SplitOde ode = known_motions::linear_ode(masses(), K, SparseMatrix(particles, particles));
  ode.stiffness = K;
  const State nearly_zero{1e-160 * noise(particles, 1), 1e-160 * noise(particles, 2)};
  Integrator integrator(ode, solver::method("implicit-euler"), tight(), nearly_zero);
  EXPECT_EQ(integrator.step(0.1).outcome, Outcome::success);
}

}  // namespace
}  // namespace drape::verify::stage_solver_test
