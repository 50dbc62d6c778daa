// The largest steps of `verlet` and `rk4`: found where they blow up, and computed from what the ODE's stiffest modes are.

#include "solver/stability.hpp"

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/decompositions.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::stability_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::rk4_limit;
using solver::Spectrum;
using solver::spectrum;
using solver::verlet_limit;

/// How far x'' = −ω² x − c x' gets from (1, 1) in sub-steps of tau, measured in x and v together; stops beyond 1e9.
double farthest(std::string_view method, const Spectrum& mode, double tau, int steps) {
  const auto scalar = [](double a) -> SparseMatrix { return Eigen::MatrixXd::Constant(1, 1, a).sparseView(); };
  const auto ode = known_motions::linear_ode(Eigen::VectorXd::Ones(1), scalar(-mode.omega_squared), scalar(-mode.decay));
  Options options;
  options.verlet_fraction = 1e9;  // one sub-step, stable or not
  Integrator integrator(ode, solver::method(method), options, {Vectors::Ones(1, 3), Vectors::Ones(1, 3)});
  double distance = 0;
  for (int n = 0; n < steps && distance < 1e9; ++n) {
    EXPECT_EQ(integrator.step(tau).outcome, Outcome::success);
    // x alone grows without bound at constant velocity
    distance =
        std::max({distance, mode.omega_squared * std::abs(integrator.state().x(0, 0)), std::abs(integrator.state().v(0, 0))});
  }
  return distance;
}

/// A name, ω² and c.
class VerletLimitOf : public testing::TestWithParam<std::tuple<std::string, double, double>> {
 protected:
  const Spectrum mode{std::get<1>(GetParam()), std::get<2>(GetParam())};
};
INSTANTIATE_TEST_SUITE_P(, VerletLimitOf,
                         testing::Values(std::tuple("undamped", 4, 0), std::tuple("overdamped", 0, 3),
                                         std::tuple("weakly_damped", 4, 0.2), std::tuple("mixed", 4, 3),
                                         std::tuple("strongly_damped", 4, 40)),
                         [](const auto& test) { return std::get<0>(test.param); });

TEST_P(VerletLimitOf, IsStableJustBelow) {
  for (const double part : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99})
    EXPECT_LE(farthest("verlet", mode, part * verlet_limit(mode), 2000), 1e3) << part;
  EXPECT_LE(farthest("verlet", mode, 0.999 * verlet_limit(mode), 100'000), 1e3);
}

TEST_P(VerletLimitOf, BlowsUpJustAbove) { EXPECT_GE(farthest("verlet", mode, 1.001 * verlet_limit(mode), 100'000), 1e9); }

TEST(VerletLimit, IsKnownForPureModes) {
  EXPECT_NEAR(verlet_limit({4, 0}), 2 / std::sqrt(4), 1e-5);
  EXPECT_NEAR(verlet_limit({0, 3}), 1 / 3.0, 1e-5);
  EXPECT_EQ(verlet_limit({0, 0}), std::numeric_limits<double>::infinity());
}

TEST(Rk4Limit, IsKnownForPureModes) {
  EXPECT_NEAR(rk4_limit({4, 0}), std::sqrt(2), 1e-5);
  EXPECT_NEAR(rk4_limit({0, 3}), 2.78529 / 3, 1e-5);
  EXPECT_EQ(rk4_limit({0, 0}), std::numeric_limits<double>::infinity());
}

TEST(Rk4Limit, IsThatOfTheWorstModeBelow) {
  DRAPE_SLOW();
  for (const Spectrum& stiffest : {Spectrum{4, 0}, {0, 3}, {4, 0.2}, {4, 3}, {4, 40}}) {
    const double limit = rk4_limit(stiffest);
    double most = 0;
    for (double part = 0; part <= 1; part += 0.05)
      for (const Spectrum& mode :
           {Spectrum{stiffest.omega_squared, part * stiffest.decay}, Spectrum{part * stiffest.omega_squared, stiffest.decay}}) {
        EXPECT_LE(farthest("rk4", mode, 0.99 * limit, 3000), 1e3) << part;
        most = std::max(most, farthest("rk4", mode, 1.02 * limit, 30'000));
      }
    EXPECT_GE(most, 1e9) << "omega^2 = " << stiffest.omega_squared << ", decay = " << stiffest.decay;
  }
}

/// The largest |eigenvalue| of M⁻¹ ∂f/∂x (or ∂f/∂v) of the free coordinates, by differences and a dense solver.
double dense_eigenvalue(const solver::SplitOde& ode, double t, const State& y, Vectors State::*argument) {
  const int n = 3 * ode.particles();
  Eigen::MatrixXd J(n, n);
  Vectors ahead(ode.particles(), 3), behind = ahead;
  const double step = 1e-6;
  for (int k = 0; k < n; ++k) {
    State moved = y;
    (moved.*argument).data()[k] += step;
    ode.force(t, moved.x, moved.v, ahead);
    (moved.*argument).data()[k] -= 2 * step;
    ode.force(t, moved.x, moved.v, behind);
    const Vectors change = ode.mass.cwiseInverse().asDiagonal() * (ahead - behind) / (2 * step);
    J.col(k) = Eigen::VectorXd::Map(change.data(), n);
  }
  for (const Pin& pin : ode.pins) {
    auto rows = J.middleRows<3>(3 * pin.particle);
    rows = (pin.free() * rows).eval();
    auto columns = J.middleCols<3>(3 * pin.particle);
    columns = (columns * pin.free()).eval();
  }
  return base::eigenvalues(J).cwiseAbs().maxCoeff();
}

/// The estimate is 1 % to the safe side.
void expect_estimates(const solver::SplitOde& ode, double t, const State& y) {
  const Spectrum estimate = spectrum(ode, t, y);
  const double omega_squared = dense_eigenvalue(ode, t, y, &State::x), decay = dense_eigenvalue(ode, t, y, &State::v);
  EXPECT_GE(estimate.omega_squared, omega_squared);
  EXPECT_LE(estimate.omega_squared, 1.0101 * omega_squared);
  EXPECT_GE(estimate.decay, decay);
  EXPECT_LE(estimate.decay, 1.0101 * decay);
}

TEST(Spectrum, IsNearThatOfADenseSolverOnSmallProblems) {
  for (const Problem& problem : problems()) {
    SCOPED_TRACE(problem.name);
    expect_estimates(problem.ode, start_time, problem.start);
  }
}

TEST(Spectrum, IsNearThatOfADenseSolverOnSheets) {
  for (const auto& [scene, n] : {std::pair("hung-corners", "7"), {"pulled", "[7, 5]"}, {"chain", "[20, 1]"}}) {
    SCOPED_TRACE(scene);
    const model::Override small[] = {{"grid.n", n}};
    const auto cloth = model::compile(model::load_scene(scene, small));
    expect_estimates(cloth.ode, 0, cloth.start);
  }
}

}  // namespace
}  // namespace drape::verify::stability_test
