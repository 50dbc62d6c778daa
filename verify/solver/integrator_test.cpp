// The driver: it arrives where and when it was told to, keeps its state when a step fails, and follows the number of updates.

#include "solver/integrator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "verify/support/small_problems.hpp"

namespace drape::verify::integrator_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::RunResult;
using solver::StepReport;
using testing::AllOf;
using testing::HasSubstr;

const Problem problem = partly_pinned();
constexpr double t_end = start_time + 1;

bool same(const State& a, const State& b) { return a.x == b.x && a.v == b.v; }

class IntegratorWith : public testing::TestWithParam<std::string> {
 protected:
  const Method& method = solver::method(GetParam());

  /// Whether all its evaluations are near the start of a step, so that forces which break later do not fail it.
  bool sees_only_the_start() const { return method.name == "explicit-euler" || method.name == "exponential-euler"; }
};
INSTANTIATE_TEST_SUITE_P(, IntegratorWith, testing::ValuesIn(names(solver::methods())),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(IntegratorWith, TakesExactlyTheStepsThatDivideTheTime) {
  for (const int n : {1, 2, 3, 7, 10, 49, 100, 1000}) {
    const Problem p = partly_pinned();
    Integrator integrator(p.ode, method, tight(), p.start, start_time);
    const RunResult run = integrate(integrator, t_end, 1.0 / n);
    ASSERT_EQ(run.outcome, Outcome::success) << run.message;
    EXPECT_EQ(run.steps, n);
    EXPECT_EQ(p.ode.work->count("steps"), n);
    EXPECT_EQ(run.rejected_steps, 0);
    EXPECT_NEAR(integrator.time(), t_end, 1e-12);
    const int most_builds = method.stages == Method::Stages::linearised ? n : 2;
    EXPECT_LE(p.ode.work->count("matrix_builds"), most_builds) << n << ": one, and one for the start, or one a step";
    EXPECT_EQ(p.ode.work->count("matrix_builds"), p.ode.work->count("factorisations")) << n;
  }
}

class IntegratorWithThesisMethod : public IntegratorWith {};
INSTANTIATE_TEST_SUITE_P(, IntegratorWithThesisMethod, testing::ValuesIn(names(solver::thesis_methods())),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(IntegratorWithThesisMethod, MakesAMatrixForItsStepsAndOneForTheStart) {
  for (const int n : {1, 2, 49}) {
    const Problem p = partly_pinned();
    Integrator integrator(p.ode, method, tight(), p.start, start_time);
    ASSERT_EQ(integrate(integrator, t_end, 1.0 / n).outcome, Outcome::success);
    const int matrices = !method.implicit() ? 0 : method.history == 2 && n > 1 ? 2 : 1;
    EXPECT_EQ(p.ode.work->count("matrix_builds"), matrices) << n;
  }
}

TEST_P(IntegratorWith, ClipsTheLastStep) {
  for (const double h : {0.3, 0.03, 0.0011, 5.0}) {
    Integrator integrator(problem.ode, method, tight(), problem.start, start_time);
    double last = 0;
    const RunResult run = integrate(integrator, t_end, h, [&](const StepReport& step) { last = step.h; });
    ASSERT_EQ(run.outcome, Outcome::success) << run.message;
    EXPECT_EQ(run.steps, std::ceil(1 / h)) << h;
    EXPECT_NEAR(last, 1 - (run.steps - 1) * h, 1e-12) << h;
    EXPECT_NEAR(integrator.time(), t_end, 1e-15) << h;
    EXPECT_EQ(run.last_good_time, integrator.time());
  }
}

TEST_P(IntegratorWith, ShowsEveryAcceptedStep) {
  Integrator integrator(problem.ode, method, tight(), problem.start, start_time);
  double t = start_time;
  int seen = 0, updates = 0;
  const auto before = problem.ode.work->count("updates");
  const RunResult run = integrate(integrator, t_end, 0.03, [&](const StepReport& step) {
    EXPECT_NEAR(step.t, t + step.h, 1e-14);
    EXPECT_EQ(step.t, integrator.time());
    EXPECT_TRUE(same(step.y, integrator.state()));
    EXPECT_TRUE(distance(step.y, problem.exact(step.t)) <= 0.1 || !method.converges);
    t = step.t;
    updates += step.updates;
    ++seen;
  });
  EXPECT_EQ(seen, run.steps);
  EXPECT_EQ(updates, problem.ode.work->count("updates") - before);
}

TEST_P(IntegratorWith, KeepsTimeAndStateWhenAStepFails) {
  if (sees_only_the_start()) GTEST_SKIP() << "evaluates no force long after the start of its step";
  const double broken_after = start_time + 0.105;
  const Problem p = breaking(broken_after);
  Integrator integrator(p.ode, method, tight(), p.start, start_time);
  for (int n = 0; n < 10; ++n) ASSERT_EQ(integrator.step(0.01).outcome, Outcome::success);
  const State before = integrator.state();
  const double t = integrator.time();
  for (int n = 0; n < 2; ++n) {
    EXPECT_NE(integrator.step(1).outcome, Outcome::success);
    EXPECT_TRUE(same(integrator.state(), before));
    EXPECT_EQ(integrator.time(), t);
  }
  EXPECT_EQ(p.ode.work->count("rejected_steps"), 2);
  EXPECT_EQ(p.ode.work->count("steps"), 10);
}

TEST_P(IntegratorWith, GoesOnAfterAFailedStepAsIfItHadNotBeen) {
  if (sees_only_the_start()) GTEST_SKIP() << "evaluates no force long after the start of its step";
  const Problem p = breaking(start_time + 0.105);
  Integrator failing(p.ode, method, tight(), p.start, start_time), undisturbed(p.ode, method, tight(), p.start, start_time);
  for (const double h : {0.01, 0.02, 0.015}) {
    ASSERT_EQ(failing.step(h).outcome, Outcome::success);
    ASSERT_EQ(undisturbed.step(h).outcome, Outcome::success);
    ASSERT_NE(failing.step(1).outcome, Outcome::success);
  }
  ASSERT_EQ(failing.step(0.015).outcome, Outcome::success);
  ASSERT_EQ(undisturbed.step(0.015).outcome, Outcome::success);
  EXPECT_TRUE(same(failing.state(), undisturbed.state()));
}

TEST_P(IntegratorWith, EndsWhereAStepFailsAndSaysWhy) {
  const Problem p = breaking(start_time + 0.105);
  Integrator integrator(p.ode, method, tight(), p.start, start_time);
  const RunResult run = integrate(integrator, t_end, 0.03);
  EXPECT_EQ(run.outcome, Outcome::not_finite);
  EXPECT_EQ(run.rejected_steps, 1);
  EXPECT_EQ(run.last_good_time, integrator.time());
  EXPECT_NEAR(run.last_good_time, start_time + 0.03 * run.steps, 1e-14);
  EXPECT_LE(run.last_good_time, start_time + 0.105 + 0.03);
  EXPECT_THAT(run.message,
              AllOf(HasSubstr("not finite"), HasSubstr(std::to_string(run.last_good_time)), HasSubstr("h = 0.03")));
}

TEST_P(IntegratorWith, KeepsPinnedCoordinatesOnTheirWay) {
  State start = problem.start;
  for (const Pin& pin : problem.ode.pins)
    for (int c = 0; c < 3; ++c) start.v(pin.particle, c) += pin.fixed(c) ? 7 : 0;  // replaced by the prescribed velocity
  Integrator integrator(problem.ode, method, tight(), start, start_time);
  ASSERT_EQ(integrate(integrator, t_end, 0.03).outcome, Outcome::success);
  const State exact = problem.exact(t_end);
  for (const Pin& pin : problem.ode.pins)
    for (int c = 0; c < 3; ++c) {
      if (!pin.fixed(c)) continue;
      EXPECT_NEAR(integrator.state().x(pin.particle, c), exact.x(pin.particle, c), 1e-13);
      EXPECT_EQ(integrator.state().v(pin.particle, c), pin.velocity[c]);
    }
}

TEST_P(IntegratorWith, BuildsAndKeepsOnlyWhatTheMethodNeeds) {
  const Problem p = partly_pinned();
  Integrator integrator(p.ode, method, tight(), p.start, start_time);
  ASSERT_EQ(integrate(integrator, t_end, 0.1).outcome, Outcome::success);
  const auto count = [&](const char* kind) { return p.ode.work->count(kind); };
  EXPECT_EQ(count("history_states"), method.history - 1);
  const bool solves = count("updates") > 0;  // newcomers may have systems of their own
  EXPECT_TRUE(method.stages != Method::Stages::none || !solves);
  for (const char* kind : {"matrix_builds", "factorisations"}) EXPECT_EQ(count(kind) > 0, solves) << kind;
  EXPECT_EQ(count("jacobian_products") > 0, method.stages == Method::Stages::exponential);
  EXPECT_EQ(count("linear_bytes") > 0, solves || count("jacobian_products") > 0);
  EXPECT_TRUE(!method.implicit() || count("matrix_products") > 0);
  EXPECT_EQ(count("substeps") > 0, method.sub_steps);
}

TEST_P(IntegratorWithThesisMethod, SolvesByTheStageSolverIfItIsImplicit) {
  const Problem p = partly_pinned();
  Integrator integrator(p.ode, method, tight(), p.start, start_time);
  const RunResult run = integrate(integrator, t_end, 0.1);
  EXPECT_EQ(run.outcome, Outcome::success);
  if (method.implicit())
    EXPECT_GE(p.ode.work->count("updates"), run.steps);
  else
    EXPECT_EQ(p.ode.work->count("matrix_entries"), 0);
}

TEST_P(IntegratorWith, RejectsStepsThatAreNotPositive) {
  Integrator integrator(problem.ode, method, tight(), problem.start, start_time);
  for (const double h : {0.0, -0.1, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(integrate(integrator, t_end, h), std::invalid_argument) << h;
}

TEST(Integrate, DoesNotLoseTimeInManySteps) {
  // Rounding adds up to more than a billionth of a step.
  const SparseMatrix none(1, 1);
  const auto ode = known_motions::linear_ode(Eigen::VectorXd::Ones(1), none, none);
  for (const int n : {10'000, 100'000, 1'000'000}) {
    Integrator integrator(ode, solver::method("verlet"), {}, {Vectors::Zero(1, 3), Vectors::Ones(1, 3)});
    EXPECT_EQ(integrate(integrator, 1, 1.0 / n).steps, n);
    EXPECT_NEAR(integrator.time(), 1, 1e-15);
  }
}

TEST(Integrate, DoesNothingWhereTheTimeIsOver) {
  Integrator integrator(problem.ode, solver::method("bdf2"), tight(), problem.start, start_time);
  const RunResult run = integrate(integrator, start_time, 0.1);
  EXPECT_EQ(run.outcome, Outcome::success);
  EXPECT_EQ(run.steps, 0);
  EXPECT_EQ(run.last_good_time, start_time);
}

TEST(Integrate, IsTheSameInOneRunAndInTwo) {
  Integrator one(problem.ode, solver::method("sbdf2"), tight(), problem.start, start_time);
  Integrator two(problem.ode, solver::method("sbdf2"), tight(), problem.start, start_time);
  integrate(one, start_time + 0.5, 0.125);
  integrate(two, start_time + 0.25, 0.125);
  integrate(two, start_time + 0.5, 0.125);
  EXPECT_TRUE(same(one.state(), two.state()));
}

}  // namespace
}  // namespace drape::verify::integrator_test
