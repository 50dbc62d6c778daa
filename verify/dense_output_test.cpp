// Positions between the steps of a run.

#include "solver/dense_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "verify/convergence.hpp"
#include "verify/small_problems.hpp"

namespace drape::verify::dense_output_test {
namespace {

using namespace small_problems;
using solver::DenseOutput;
using solver::Integrator;
using solver::positions_within;
using testing::ElementsAre;
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

/// Largest error of positions between exact states, over all steps of h in a second.
double largest_error(double h) {
  double error = 0;
  for (double t0 = 0; t0 < 1 - h / 2; t0 += h)
    for (int k = 0; k <= 20; ++k) {
      const double t = t0 + 0.05 * k * h;
      error = std::max(error, largest(positions_within(t, t0, spiral(t0), t0 + h, spiral(t0 + h)) - spiral(t).x));
    }
  return error;
}

TEST(PositionsWithinAStep, AreOfFourthOrder) {
  Convergence c{{0.1, 0.05, 0.025, 0.0125}, {}};
  for (const double h : c.steps) c.errors.push_back(largest_error(h));
  EXPECT_TRUE(has_order(c, 4));
}

TEST(PositionsWithinAStep, AreExactAtBothEndsWhateverTheStates) {
  const State y0{noise(5, 1), noise(5, 2)}, y1{noise(5, 3), noise(5, 4)};
  EXPECT_EQ(positions_within(0.3, 0.3, y0, 0.7, y1), y0.x);
  EXPECT_EQ(positions_within(0.7, 0.3, y0, 0.7, y1), y1.x);
}

TEST(PositionsWithinAStep, AreExactOnCubics) {
  for (const double t : {0.21, 0.3, 0.49})
    EXPECT_LE(largest(positions_within(t, 0.2, cubic(0.2), 0.5, cubic(0.5)) - cubic(t).x), 1e-15) << t;
}

TEST(DenseOutput, IsThereForAllTimesOfStepsOfAnySize) {
  const std::vector<double> times{0.1, 0.15, 0.199, 0.2, 0.35, 0.9};
  DenseOutput output(times, 0.1, cubic(0.1));
  for (const double t : {0.2, 0.3, 0.8}) output.see(t, cubic(t));
  ASSERT_THAT(output.positions, SizeIs(5)) << "the last was not reached";
  for (std::size_t k = 0; k < 5; ++k) EXPECT_LE(largest(output.positions[k] - cubic(times[k]).x), 2e-15) << times[k];
}

TEST(DenseOutput, TakesStatesAsTheyAreWhereStepsEnd) {
  const std::vector<double> times{0.3 - 1e-12, 0.3, 0.1 + 0.2};
  DenseOutput output(times, 0, cubic(0));
  State end = cubic(0.3);
  end.v *= 7;
  output.see(0.3, end);
  EXPECT_THAT(output.positions, ElementsAre(end.x, end.x, end.x));
}

TEST(DenseOutput, FollowsARunBetweenItsSteps) {
  const Problem problem = free_particles();
  const double t0 = start_time, within = t0 + 0.233;
  Integrator integrator(problem.ode, solver::method("esdirk4"), tight(), problem.start, t0);
  const std::vector<double> times{within};
  DenseOutput output(times, t0, integrator.state());
  integrate(integrator, t0 + 0.3, 0.01, [&](const solver::StepReport& step) { output.see(step.t, step.y); });
  ASSERT_THAT(output.positions, SizeIs(1));
  EXPECT_LE(largest(output.positions[0] - problem.exact(within).x), 1e-7);
}

}  // namespace
}  // namespace drape::verify::dense_output_test
