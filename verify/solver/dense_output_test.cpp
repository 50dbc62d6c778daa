// States between the steps of a run.

#include "solver/dense_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verify/support/convergence.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::dense_output_test {
namespace {

using namespace small_problems;
using solver::DenseOutput;
using solver::Integrator;
using solver::state_within;
using testing::SizeIs;

/// A particle on a spiral.
State spiral(double t) {
  State y{Vectors(1, 3), Vectors(1, 3)};
  y.x << std::sin(3 * t), std::cos(2 * t), std::exp(-t);
  y.v << 3 * std::cos(3 * t), -2 * std::sin(2 * t), -std::exp(-t);
  return y;
}

/// On a cubic.
State cubic(double t) {
  State y{Vectors(1, 3), Vectors(1, 3)};
  y.x << 1 + t * t * t, 2 * t * t - t, t;
  y.v << 3 * t * t, 4 * t - 1, 1;
  return y;
}

/// Largest errors of positions and of velocities between exact states, over all steps of h in a second.
struct Errors {
  double x = 0, v = 0;
};
Errors largest_errors(double h) {
  Errors error;
  for (double t0 = 0; t0 < 1 - h / 2; t0 += h)
    for (int k = 0; k <= 20; ++k) {
      const double t = t0 + 0.05 * k * h;
      const State y = state_within(t, t0, spiral(t0), t0 + h, spiral(t0 + h)), exact = spiral(t);
      error = {std::max(error.x, largest(y.x - exact.x)), std::max(error.v, largest(y.v - exact.v))};
    }
  return error;
}

TEST(StateWithinAStep, IsOfFourthOrderItsVelocityOfThird) {
  Convergence x{{0.1, 0.05, 0.025, 0.0125}, {}}, v = x;
  for (const double h : x.steps) {
    const Errors errors = largest_errors(h);
    x.errors.push_back(errors.x);
    v.errors.push_back(errors.v);
  }
  EXPECT_TRUE(has_order(x, 4));
  EXPECT_TRUE(has_order(v, 3));
}

TEST(StateWithinAStep, IsExactAtBothEndsWhateverTheStates) {
  const State y0{noise(5, 1), noise(5, 2)}, y1{noise(5, 3), noise(5, 4)};
  const State begin = state_within(0.3, 0.3, y0, 0.7, y1), end = state_within(0.7, 0.3, y0, 0.7, y1);
  EXPECT_EQ(begin.x, y0.x);
  EXPECT_EQ(begin.v, y0.v);
  EXPECT_EQ(end.x, y1.x);
  EXPECT_EQ(end.v, y1.v);
}

TEST(StateWithinAStep, IsExactOnCubics) {
  for (const double t : {0.21, 0.3, 0.49}) {
    const State y = state_within(t, 0.2, cubic(0.2), 0.5, cubic(0.5));
    EXPECT_LE(largest(y.x - cubic(t).x), 1e-15) << t;
    EXPECT_LE(largest(y.v - cubic(t).v), 1e-14) << t;
  }
}

TEST(DenseOutput, IsThereForAllTimesOfStepsOfAnySize) {
  const std::vector<double> times{0.1, 0.15, 0.199, 0.2, 0.35, 0.9};
  DenseOutput output(times, 0.1, cubic(0.1));
  for (const double t : {0.2, 0.3, 0.8}) output.observe(t, cubic(t));
  ASSERT_THAT(output.states, SizeIs(5)) << "the last was not reached";
  for (std::size_t k = 0; k < 5; ++k) EXPECT_LE(largest(output.states[k].x - cubic(times[k]).x), 2e-15) << times[k];
}

TEST(DenseOutput, TakesStatesAsTheyAreWhereStepsEnd) {
  const std::vector<double> times{0.3 - 1e-12, 0.3, 0.1 + 0.2};
  DenseOutput output(times, 0, cubic(0));
  State end = cubic(0.3);
  end.v *= 7;
  output.observe(0.3, end);
  ASSERT_THAT(output.states, SizeIs(3));
  for (const State& y : output.states) {
    EXPECT_EQ(y.x, end.x);
    EXPECT_EQ(y.v, end.v);
  }
}

TEST(DenseOutput, FollowsARunBetweenItsSteps) {
  const Problem problem = free_particles();
  const double t0 = start_time, within = t0 + 0.233;
  Integrator integrator(problem.ode, solver::method("esdirk4"), tight(), problem.start, t0);
  const std::vector<double> times{within};
  DenseOutput output(times, t0, integrator.state());
  integrate(integrator, t0 + 0.3, 0.01, [&](const solver::StepReport& step) { output.observe(step.t, step.y); });
  ASSERT_THAT(output.states, SizeIs(1));
  EXPECT_LE(largest(output.states[0].x - problem.exact(within).x), 1e-7);
}

}  // namespace
}  // namespace drape::verify::dense_output_test
