// A method that the table does not have, as newcomers write them (verify/newcomers), with memory beyond the state. What works
// for the table's methods works for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reference/theory/amplification.hpp"
#include "reference/theory/linear_prediction.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::solver {

void gen_alpha(Step& s);

}  // namespace drape::solver

namespace drape::verify::newcomers_test {
namespace {

using namespace small_problems;
using reference::Mode;
using solver::Integrator;
using Stages = Method::Stages;

const std::vector<Method> newcomers{{.name = "gen-alpha",
                                     .description = "generalised alpha",
                                     .order = 2,
                                     .stages = Stages::nonlinear,
                                     .step = solver::gen_alpha,
                                     .forces = 1,
                                     .meets_obstacles = false}};

class Newcomer : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(, Newcomer, testing::ValuesIn(newcomers),
                         [](const auto& test) { return identifier(std::string(test.param.name)); });

/// Errors of steps that change by up to 1.5.
Convergence errors_of(const Problem& problem, const Method& method) {
  Convergence measured;
  for (const int n : {150, 300, 600, 1200}) {
    Integrator integrator(problem.ode, method, tight(), problem.start, start_time);
    double worst = 0;
    for (int k = 0; k < n; ++k) {
      const double h = 1.2 / n * (k % 3 ? 1.5 : 1.0);
      EXPECT_EQ(integrator.step(h).outcome, solver::Outcome::success);
      worst = std::max(worst, distance(integrator.state(), problem.exact(integrator.time())));
    }
    measured.steps.push_back(1.2 / n);
    measured.errors.push_back(worst);
  }
  return measured;
}

TEST_P(Newcomer, HasItsOrderWithPinsAndUnequalSteps) {
  for (const Problem& problem : problems())
    EXPECT_TRUE(has_order(errors_of(problem, GetParam()), GetParam().order)) << problem.name;
}

TEST_P(Newcomer, HasNoTheory) {
  EXPECT_FALSE(reference::has_theory(GetParam().name));
  EXPECT_FALSE(reference::predict(GetParam(), 1e3, 1));
}

TEST_P(Newcomer, HasAmplificationFactorsAllTheSame) {
  for (const Mode& mode : {Mode{1, 1, 0}, {4, 1, 0.3}, {10, 0.1, 0}, {1e4, 10, 2}, {1e6, 1e6, 1}}) {
    const double radius = reference::spectral_radius(GetParam(), mode);
    EXPECT_TRUE(radius > 0 && radius < 1 + 1e-9) << radius;
  }
}

TEST(GenAlpha, HasTheSpectralRadiusOfItsName) {
  EXPECT_NEAR(reference::spectral_radius(newcomers[0], {1e8, 1e8, 0}), 1.0 / 3, 1e-2) << "a double factor";
  EXPECT_NEAR(std::pow(reference::spectral_radius(newcomers[0], {1e-4, 1e-4, 0}), 100), 1, 1e-4);
}

TEST(GenAlpha, IsMeasuredAsTheIntegratorMovesIt) {
  const Mode mode{0.25, 0.25, 0};
  const auto measured = reference::measured_behaviour(newcomers[0], mode);
  constexpr double h = 0.1;
  const auto ode = reference::mode_ode({mode.nu / h / h, mode.W / h / h, 0});
  Integrator integrator(ode, newcomers[0], tight(), known_motions::single({1, 0, 0.3}, {0, 0, -5}));
  std::vector<double> x;
  for (int n = 0; n < 30; ++n) {
    EXPECT_EQ(integrator.step(h).outcome, solver::Outcome::success);
    x.push_back(integrator.state().x(0, 0));
  }
  const double decay = std::exp(-measured.decay), trace = 2 * decay * std::cos(measured.frequency);
  EXPECT_NEAR(x[29], trace * x[28] - decay * decay * x[27], 1e-8);
}

}  // namespace
}  // namespace drape::verify::newcomers_test
