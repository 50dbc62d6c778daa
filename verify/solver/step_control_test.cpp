// Step control follows the number of updates, cuts what fails, and knows when to give up. `verlet` chooses its own sub-steps.

#include <gtest/gtest.h>

#include <limits>

#include "verify/support/small_problems.hpp"

namespace drape::verify::step_control_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::RunResult;
using solver::StepReport;

const Problem problem = partly_pinned();
constexpr double t_end = start_time + 1;

Options controlled(int min_updates, int max_updates, double factor = 1.5) {
  Options options = tolerances(1e-8, 1e-9);
  options.control = {min_updates, max_updates, factor};
  return options;
}

TEST(StepControl, FollowsTheNumberOfUpdates) {
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"}) {
    Integrator integrator(problem.ode, solver::method(method), controlled(5, 8), problem.start, start_time);
    std::vector<double> steps;
    std::vector<int> updates;
    int grown = 0, shrunk = 0;
    const RunResult run = integrate(integrator, start_time + 8, 1e-3, [&](const StepReport& step) {
      steps.push_back(step.h);
      updates.push_back(step.updates);
    });
    ASSERT_EQ(run.outcome, Outcome::success) << run.message;
    ASSERT_EQ(run.rejected_steps, 0);
    for (std::size_t n = 0; n + 2 < steps.size(); ++n) {  // the last one is clipped
      const double expected = updates[n] < 5 ? 1.5 : updates[n] > 8 ? 1 / 1.5 : 1;
      EXPECT_NEAR(steps[n + 1] / steps[n], expected, 1e-12) << method << ": " << updates[n] << " updates in step " << n;
      grown += expected > 1;
      shrunk += expected < 1;
    }
    EXPECT_GE(grown, 5) << method;
    EXPECT_GE(shrunk, 1) << method;
  }
}

TEST(StepControl, CutsStepsThatFailAndArrivesAllTheSame) {
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"}) {
    Options options = controlled(4, 6);
    options.max_updates = 7;
    Integrator integrator(problem.ode, solver::method(method), options, problem.start, start_time);
    const RunResult run = integrate(integrator, t_end, 0.5);
    EXPECT_EQ(run.outcome, Outcome::success) << run.message;
    EXPECT_GE(run.rejected_steps, 2) << method;
    EXPECT_NEAR(integrator.time(), t_end, 1e-14);
    EXPECT_LE(distance(integrator.state(), problem.exact(t_end)), 0.1) << method;

    options.control = {};
    Integrator without(problem.ode, solver::method(method), options, problem.start, start_time);
    EXPECT_EQ(integrate(without, t_end, 0.5).outcome, Outcome::not_converged) << method;
  }
}

TEST(StepControl, GivesUpInFrontOfAWall) {
  const double wall = start_time + 0.105;
  const Problem p = breaking(wall);
  for (const Method& method : solver::methods()) {
    Integrator integrator(p.ode, method, controlled(0, 1000), p.start, start_time);
    const RunResult run = integrate(integrator, t_end, 0.03);
    EXPECT_EQ(run.outcome, Outcome::not_finite) << method.name;
    EXPECT_GT(run.last_good_time, start_time + 0.06) << method.name;
    EXPECT_LE(run.last_good_time, wall + 0.03) << method.name;
    EXPECT_GE(run.rejected_steps, 10) << method.name;
    EXPECT_LE(run.rejected_steps, 100) << method.name;
    EXPECT_TRUE(integrator.state().x.allFinite()) << method.name;
  }
}

TEST(Verlet, TakesSubStepsInsideItsLimit) {
  const Problem p = partly_pinned();
  Options options = tight();
  options.verlet_fraction = 0.25;
  Integrator integrator(p.ode, solver::method("verlet"), options, p.start, start_time);
  ASSERT_EQ(integrate(integrator, t_end, 0.5).outcome, Outcome::success);
  const double substep = 1.0 / static_cast<double>(p.ode.work->count("substeps"));
  EXPECT_LE(distance(integrator.state(), p.exact(t_end)), 1e-2);
  options.verlet_fraction = 0.125;
  Integrator finer(p.ode, solver::method("verlet"), options, p.start, start_time);
  const auto before = p.ode.work->count("substeps");
  ASSERT_EQ(integrate(finer, t_end, 0.5).outcome, Outcome::success);
  EXPECT_NEAR(substep * static_cast<double>(p.ode.work->count("substeps") - before), 2, 0.15);
}

TEST(Verlet, DoesNotHangWhereItsLimitIsUnknown) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Problem p = partly_pinned();
    p.ode.force = [force = p.ode.force, bad](double t, const Vectors& x, const Vectors& v, Vectors& f) {
      force(t, x, v, f);
      f(2, 0) = bad;
    };
    Integrator integrator(p.ode, solver::method("verlet"), {}, p.start, start_time);
    EXPECT_EQ(integrator.step(0.01).outcome, Outcome::not_finite);
    EXPECT_EQ(integrator.time(), start_time);
  }
}

}  // namespace
}  // namespace drape::verify::step_control_test
