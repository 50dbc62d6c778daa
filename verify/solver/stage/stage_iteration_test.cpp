// Chebyshev's weights, L-BFGS, vertex block descent and the printed loop solve the same stage as the fixed-point loop.

#include "solver/stage/stage_iteration.hpp"

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/theory/amplification.hpp"
#include "solver/stage/chebyshev.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::stage_iteration_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::Stage;
using solver::StageResult;
using solver::StageSolver;

Options with(const std::string& kind, double loop, double cg) {
  Options options = tolerances(loop, cg);
  options.stage = &solver::stage_kind(kind);
  return options;
}

/// An implicit Euler step from the start of a problem, with a bad guess.
struct Case {
  explicit Case(const Problem& chosen) : problem(chosen) {
    prescribe(problem.ode.pins, y.v);
    y.x += gamma * y.v;
  }

  Problem problem;
  const double gamma = 0.04;
  State y{problem.start.x, 3 * noise(particles, 21)};

  StageResult solve(const Options& options) {
    return StageSolver(problem.ode, options).solve({gamma, start_time + gamma, problem.start.x, problem.start.v}, y);
  }
  Vectors residual() const {
    Vectors f(particles, 3);
    problem.ode.force(start_time + gamma, y.x, y.v, f);
    Vectors r = problem.ode.mass.asDiagonal() * (problem.start.v - y.v) + gamma * f;
    filter(problem.ode.pins, r);
    return r;
  }
  /// |b| = |r + A v| at the present state.
  double right_hand_side() const {
    Vectors b =
        problem.ode.mass.asDiagonal() * y.v - gamma * gamma * problem.ode.stiffness * y.v - gamma * problem.ode.damping * y.v;
    b += residual();
    filter(problem.ode.pins, b);
    return b.norm();
  }
};

class Iterations : public testing::TestWithParam<std::tuple<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(, Iterations,
                         testing::Combine(testing::Values("printed-loop", "chebyshev", "lbfgs"),
                                          testing::ValuesIn(names(problems()))),
                         [](const auto& test) { return identifier(std::get<0>(test.param)) + "_" + std::get<1>(test.param); });

TEST_P(Iterations, SolveTheStage) {
  const auto& [kind, problem] = GetParam();
  for (const auto& linear : solver::linear_solvers()) {
    Case c(problem_named(problem));
    Options options = with(kind, 1e-12, 1e-12);
    options.linear_solver = &linear;
    ASSERT_EQ(c.solve(options).outcome, Outcome::success) << linear.name;
    EXPECT_LE(c.residual().norm(), 1e-10) << linear.name;
    EXPECT_LE(largest(c.y.x - c.problem.start.x - c.gamma * c.y.v), 1e-15);
    Vectors prescribed = c.y.v;
    prescribe(c.problem.ode.pins, prescribed);
    EXPECT_LE(largest(c.y.v - prescribed), 1e-14);
  }
}

/// The loop as printed compares with b where it ends, the others with b where they began.
TEST_P(Iterations, EndAtTheirTolerance) {
  const auto& [kind, problem] = GetParam();
  if (problem == "towed") GTEST_SKIP() << "A has no couplings with particles that are pinned, and b does not, either";
  int before = 0;
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    Case c(problem_named(problem));
    Options options = with(kind, tolerance, tolerance);
    options.linear_solver = &solver::linear_solver("cholesky");
    const double first = c.right_hand_side();
    const StageResult result = c.solve(options);
    ASSERT_EQ(result.outcome, Outcome::success);
    const double b = kind == "printed-loop" ? c.right_hand_side() : first;
    EXPECT_LE(c.residual().norm(), tolerance * b * (1 + 1e-9)) << tolerance;
    EXPECT_GE(c.residual().norm(), 1e-4 * tolerance * b) << "more work than asked for";
    EXPECT_GE(result.updates, before);
    before = result.updates;
  }
  EXPECT_GE(before, 5);
}

TEST_P(Iterations, GiveUpAfterTheAllowedUpdates) {
  const auto& [kind, problem] = GetParam();
  Options options = with(kind, 1e-12, 1e-12);
  options.max_updates = 2;
  const StageResult result = Case(problem_named(problem)).solve(options);
  EXPECT_EQ(result.outcome, Outcome::not_converged);
  EXPECT_EQ(result.updates, 2);
}

TEST_P(Iterations, SeeForcesThatAreNotFinite) {
  const auto& [kind, problem] = GetParam();
  Case c(problem_named(problem));
  c.problem.ode.force = [](double, const Vectors&, const Vectors&, Vectors& f) { f.setConstant(std::nan("")); };
  EXPECT_EQ(c.solve(with(kind, 1e-5, 1e-5)).outcome, Outcome::not_finite);
}

/// Its last test is of b where it ended, and CG takes no iteration then: from there the loop does nothing.
TEST(PrintedLoop, EndsWhereConjugateGradientsTakeNoIteration) {
  Case c(free_particles());
  const Options options = with("printed-loop", 1, 1e-6);  // the loop's tolerance means nothing to it
  ASSERT_GT(c.solve(options).updates, 2);
  EXPECT_LE(c.residual().norm(), 1e-6 * c.right_hand_side() * (1 + 1e-9));
  const StageResult again = c.solve(options);
  EXPECT_EQ(again.updates, 0);
  EXPECT_EQ(again.cg_iterations, 0);
}

TEST(ChebyshevWeights, AreThePublishedOnes) {
  solver::ChebyshevWeights weights(0.8, 3);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(weights.next(), 1);
  const double second = 2 / (2 - 0.64), third = 4 / (4 - 0.64 * second);
  EXPECT_DOUBLE_EQ(weights.next(), second);
  EXPECT_DOUBLE_EQ(weights.next(), third);
  double last = 0;
  for (int k = 0; k < 200; ++k) last = weights.next();
  EXPECT_NEAR(last, 2 / (1 + 0.6), 1e-12) << "2/(1 + √(1 − ρ²))";
  weights.restart();
  EXPECT_EQ(weights.next(), 1);
}

model::Cloth sheet(const char* damping) {
  const model::Override changes[] = {{"grid.n", "8"}, {"material.damping", damping}};
  return model::compile(model::load_scene("hung-corners", changes));
}

class IterationsOnCloth : public testing::TestWithParam<std::string> {
 protected:
  State end(const model::Cloth& cloth, const Options& options, const char* method) const {
    Integrator integrator(cloth.ode, solver::method(method), options, cloth.start);
    for (int n = 0; n < 10; ++n) EXPECT_EQ(integrator.step(0.01).outcome, Outcome::success) << n;
    return integrator.state();
  }
};
INSTANTIATE_TEST_SUITE_P(, IterationsOnCloth, testing::Values("printed-loop", "chebyshev", "lbfgs", "vbd"),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(IterationsOnCloth, SolveTheSameEquationAsTheFixedPointLoop) {
  DRAPE_SLOW();
  for (const char* damping : {"50", "5"}) {
    const model::Cloth cloth = sheet(damping);
    const State exact = end(cloth, tight(), "implicit-euler");
    const State ours = end(cloth, with(GetParam(), 1e-10, 1e-11), "implicit-euler");
    EXPECT_LE(distance(ours, exact), 1e-7) << damping;
  }
}

/// Stages of generalised α have another inertia in x than in v: with the matrix for that a linear stage takes one correction.
TEST(StageIteration, KnowsTheInertiaOfAStage) {
  for (const char* kind : {"fixed-point", "printed-loop", "chebyshev", "lbfgs"}) {
    const auto ode = reference::mode_ode({10, 10, 0.1});
    Integrator integrator(ode, solver::method("generalized-alpha"), with(kind, 1e-8, 1e-9),
                          known_motions::single({1, 0, 0.3}, {0, 0.8, -0.5}));
    for (int n = 0; n < 3; ++n) {
      const StageResult step = integrator.step(0.5);
      EXPECT_EQ(step.outcome, Outcome::success) << kind;
      EXPECT_EQ(step.updates, 1) << kind;
    }
  }
}

TEST_P(IterationsOnCloth, FallBackToTheLoopInContact) {
  const model::Override small[] = {{"grid.n", "6"}};
  const model::Cloth cloth = model::compile(model::load_scene("box_swing", small));
  const auto run = [&](const Options& options) {
    Integrator integrator(cloth.ode, solver::method("bdf2"), options, cloth.start);
    EXPECT_EQ(integrate(integrator, 0.02, 0.002).outcome, Outcome::success);
    return integrator.state();
  };
  EXPECT_LE(distance(run(with(GetParam(), 1e-9, 1e-10)), run(tolerances(1e-11, 1e-12))), 1e-6);
}

/// As in study stages, where the loop contracts by little.
TEST(StageIteration, TakesFewerUpdatesThanTheLoopWhereItIsSlow) {
  const auto updates = [](const char* kind) {
    const model::Cloth cloth = sheet("0.5");
    Integrator integrator(cloth.ode, solver::method("implicit-euler"), with(kind, 1e-5, 1e-6), cloth.start);
    int sum = 0;
    integrate(integrator, 0.1, 0.01, [&](const solver::StepReport& step) { sum += step.updates; });
    return sum;
  };
  const int loop = updates("fixed-point");
  EXPECT_LE(2 * updates("chebyshev"), loop);
  EXPECT_LE(3 * updates("lbfgs"), loop);
}

TEST(VertexDescent, NeedsAMatrix) {
  model::Cloth cloth = sheet("5");
  cloth.ode.newton_matrix = nullptr;
  EXPECT_THROW(Integrator(cloth.ode, solver::method("bdf2"), with("vbd", 1e-5, 1e-6), cloth.start), std::invalid_argument);
}

}  // namespace
}  // namespace drape::verify::stage_iteration_test
