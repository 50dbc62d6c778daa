// On a single linear mode every step multiplies by the roots of a polynomial that is known; and so the largest stable step, the
// artificial inertia and the artificial damping.

#include "reference/theory/amplification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "verify/support/convergence.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::amplification_test {
namespace {

using namespace small_problems;
using reference::amplification_matrix;
using reference::characteristic_polynomial;
using reference::distance_from_theory;
using reference::LinearMode;
using reference::measured_behaviour;
using reference::Mode;
using reference::mode_ode;
using reference::ModeBehaviour;
using reference::stability_bound;
using reference::stability_limit;
using solver::Integrator;
using solver::method;
using solver::Outcome;

class Amplification : public testing::TestWithParam<std::string> {};
std::vector<std::string> methods_with_theory() {
  std::vector<std::string> known = names(solver::methods());
  std::erase_if(known, [](const std::string& name) { return !reference::has_theory(name); });
  return known;
}
INSTANTIATE_TEST_SUITE_P(, Amplification, testing::ValuesIn(methods_with_theory()),
                         [](const auto& test) { return identifier(test.param); });

/// In-plane, where all is in K, and transverse with a strain of 0.3 and of 0.001.
constexpr double whole_to_implicit[] = {1, 0.3 / 1.3, 1e-3 / 1.001};

TEST_P(Amplification, IsThatOfTheCharacteristicPolynomial) {
  DRAPE_SLOW();
  const bool is_explicit = method(GetParam()).explicit_springs();
  for (const double ratio : whole_to_implicit)
    for (int decade = -2; decade <= 6; ++decade)
      for (const double s : {0.0, 0.01, 1.0, 100.0}) {
        const double nu = std::pow(10, decade);
        const Mode mode{nu, ratio * nu, s};
        if (is_explicit && mode.W > 1e3) continue;  // far outside its limit
        EXPECT_LE(distance_from_theory(method(GetParam()), mode, mode), 1e-10)
            << "nu = " << nu << ", W = " << mode.W << ", s = " << s;
      }
}

TEST_P(Amplification, IsNotThatOfAnotherMode) {
  EXPECT_GE(distance_from_theory(method(GetParam()), {4, 1, 0.1}, {4, 1.001, 0.1}), 1e-5);
  EXPECT_GE(distance_from_theory(method(GetParam()), {4, 1, 0.1}, {4, 1, 0.1001}), 1e-6);
}

/// The positions of one particle, whose coordinates start differently, at the start and after every step of the integrator
/// with its own first step, until it is 1e9 away.
std::vector<Eigen::RowVector3d> positions(std::string_view name, const Mode& mode, int steps) {
  const double h = 0.1;
  Options options = tight();
  options.max_updates = 100'000;
  options.verlet_fraction = 1e3;  // one sub-step, stable or not
  const auto ode = mode_ode({mode.nu / h / h, mode.W / h / h, mode.s / h});
  Integrator integrator(ode, method(name), options, known_motions::single({1, 0, 0.3}, {0, 8, -5}));
  std::vector<Eigen::RowVector3d> x = {integrator.state().x.row(0)};
  for (int n = 0; n < steps && x.back().norm() < 1e9; ++n) {
    const Outcome outcome = integrator.step(h).outcome;
    if (outcome != Outcome::success) ADD_FAILURE() << name << ": " << to_string(outcome) << " in step " << n;
    x.emplace_back(integrator.state().x.row(0));
  }
  return x;
}

/// The largest |Σ p_k x_{n+k}| beside the sizes of its summands.
double left_over(const Eigen::VectorXd& p, const std::vector<Eigen::RowVector3d>& x) {
  double worst = 0;
  for (std::size_t n = 0; n + p.size() <= x.size(); ++n) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    double size = 0;
    for (Eigen::Index k = 0; k < p.size(); ++k) {
      sum += p[k] * x[n + k];
      size += std::abs(p[k]) * x[n + k].norm();
    }
    worst = std::max(worst, sum.norm() / size);
  }
  return worst;
}

TEST_P(Amplification, IsWhatTheIntegratorDoes) {
  for (const Mode& mode : {Mode{1, 1, 0}, {4, 1, 0.3}, {10, 0.1, 0}, {10, 0.01, 2}, {1, 1.5, 0.2}, {100, 80, 10}})
    EXPECT_LE(left_over(characteristic_polynomial(GetParam(), mode), positions(GetParam(), mode, 12)), 1e-10)
        << "nu = " << mode.nu << ", W = " << mode.W << ", s = " << mode.s;
  EXPECT_GE(left_over(characteristic_polynomial(GetParam(), {4, 1.001, 0}), positions(GetParam(), {4, 1, 0}, 12)), 1e-5);
}

constexpr const char* implicit_without_split[] = {"implicit-euler", "bdf2", "midpoint"};

TEST(FixedPointLoop, HasALimitThatDoesNotDependOnTheSplit) {
  for (const char* name : implicit_without_split)
    for (const Mode& mode : {Mode{10, 0.1, 0.01}, {100, 1, 5}, {1e4, 100, 0}, {1, 1.5, 0}}) {
      const Eigen::MatrixXd G = amplification_matrix(method(name), {mode.W, mode.W, mode.s});
      EXPECT_LE((amplification_matrix(method(name), mode) - G).norm(), 1e-11 * G.norm()) << name << " with nu = " << mode.nu;
    }
}

/// The updates of the third step.
int updates(std::string_view name, const Mode& mode, double loop_tolerance) {
  Options options = tight();
  options.loop_tolerance = loop_tolerance;
  const auto ode = mode_ode({mode.nu, mode.W, mode.s});
  Integrator integrator(ode, method(name), options, known_motions::single({1, 0, 0.3}, {0, 0.8, -0.5}));
  integrator.step(1), integrator.step(1);
  return integrator.step(1).updates;
}

TEST(FixedPointLoop, ContractsAsTheModeSays) {
  for (const char* name : implicit_without_split)
    for (const Mode& mode : {Mode{1, 1.5, 0}, {4, 1, 0.3}, {10, 0.1, 0}, {100, 1, 5}}) {
      const double predicted = std::log(1e-4 / 1e-10) / -std::log(reference::loop_contraction(name, mode));
      EXPECT_NEAR(updates(name, mode, 1e-10) - updates(name, mode, 1e-4), predicted, 1.01) << name << " with nu = " << mode.nu;
    }
}

// --- Stability --------------------------------------------------------------------------------------------------------------

TEST_P(Amplification, IsStableUpToTheLimitInClosedForm) {
  DRAPE_SLOW();
  for (const LinearMode& mode : {LinearMode{1, 1, 0}, {2, 3, 0}, {0.3, 1, 0}, {0.3, 1, 0.5}, {1e-3, 1, 0.2}, {1e3, 1, 3}}) {
    const double h = stability_limit(method(GetParam()), mode);
    if (std::isinf(h)) {
      if (std::isnan(stability_bound(GetParam(), 1, 1))) continue;  // not known
      for (const double W : {1e-2, 1.0, 1e2, 1e4}) {
        const Mode any = at_step(mode, std::sqrt(W / mode.omega_squared));
        EXPECT_LE(any.W, stability_bound(GetParam(), any.nu, any.s)) << "kappa = " << mode.kappa;
      }
    } else {
      const Mode limit = at_step(mode, h);
      if (std::isnan(stability_bound(GetParam(), limit.nu, limit.s))) continue;
      EXPECT_NEAR(limit.W, stability_bound(GetParam(), limit.nu, limit.s), 2e-4 * limit.W) << "kappa = " << mode.kappa;
    }
  }
}

/// Up to which ω²/κ a semi-implicit method is stable with any step.
constexpr std::pair<const char*, double> enough_is_implicit[] = {{"imex-euler", 2}, {"sbdf2", 4.0 / 3}, {"imex-midpoint", 1}};

TEST(StabilityLimit, DoesNotExistWhereEnoughIsImplicit) {
  for (const auto& [name, ratio] : enough_is_implicit) {
    for (const double in_plane_or_transverse : whole_to_implicit)
      EXPECT_EQ(stability_limit(method(name), {1, in_plane_or_transverse, 0}), INFINITY) << name;
    EXPECT_EQ(stability_limit(method(name), {1, 0.99 * ratio, 0}), INFINITY) << name;
    EXPECT_LE(stability_limit(method(name), {1, 1.01 * ratio, 0}), 100) << name;
  }
}

TEST(StabilityLimit, OfSbdf2IsZeroWhereLessThanHalfIsImplicit) {
  EXPECT_EQ(stability_limit(method("sbdf2"), {0.49, 1, 0}), 0);
  EXPECT_GE(stability_limit(method("sbdf2"), {0.51, 1, 0}), 4);
}

/// Where a method becomes unstable.
struct Limit {
  const char* method;
  double nu, s;
};
constexpr Limit limits[] = {{"imex-euler", 0.5, 0}, {"imex-euler", 3, 0.4},      {"imex-euler", 50, 10},
                            {"sbdf2", 0.5, 0},      {"sbdf2", 1.5, 0},           {"sbdf2", 3, 0},
                            {"sbdf2", 50, 0},       {"imex-midpoint", 0.5, 0.2}, {"imex-midpoint", 30, 0.2},
                            {"verlet", 0, 0},       {"verlet", 0, 0.3},          {"explicit-euler", 0, 0.3},
                            {"rk4", 0, 0},          {"explicit-midpoint", 0, 1}, {"rk4-substeps", 0, 0},
                            {"bridson", 0, 0},      {"bridson", 0, 30}};

double farthest(const std::vector<Eigen::RowVector3d>& x) {
  double distance = 0;
  for (const Eigen::RowVector3d& p : x) distance = std::max(distance, p.norm());
  return distance;
}

TEST(StabilityLimit, IsWhereTheMethodsBlowUp) {
  for (const auto& [name, nu, s] : limits) {
    const double W = stability_bound(name, nu, s);
    EXPECT_LE(farthest(positions(name, {nu, 0.99 * W, s}, 3000)), 1e3) << name << " with nu = " << nu;
    EXPECT_GE(farthest(positions(name, {nu, 1.01 * W, s}, 100'000)), 1e9) << name << " with nu = " << nu;
  }
}

TEST(StabilityLimit, DoesNotExistForImplicitMethods) {
  for (const char* name : implicit_without_split)
    for (const double W : {1e-2, 1.0, 4.1, 1e2}) {
      const auto x = positions(name, {W, W, 0}, 100);
      EXPECT_LE(farthest({x.end() - 50, x.end()}), farthest({x.begin(), x.begin() + 50}) * 1.001) << name << " with W = " << W;
    }
}

/// What undamped oscillations grow by in a step, in closed form.
struct Growth {
  const char* method;
  double (*squared)(double W);
};
constexpr Growth undamped_growth[] = {{"explicit-euler", [](double W) { return 1 + W; }},
                                      {"explicit-midpoint", [](double W) { return 1 + W * W / 4; }},
                                      {"rk4", [](double W) { return 1 - W * W * W / 72 + W * W * W * W / 576; }},
                                      {"rkl2", [](double W) { return 1 + W * W / 4; }},
                                      {"rkc2", [](double W) { return 1 + W * W / 4; }}};

TEST(ExplicitMethods, GrowUndampedAsInClosedForm) {
  for (const auto& [name, squared] : undamped_growth)
    for (const double W : {0.01, 0.3, 7.9, 8.1, 40.0})
      EXPECT_NEAR(std::pow(reference::spectral_radius(method(name), {W, W, 0}), 2), squared(W), 1e-12 * (1 + squared(W)))
          << name;
}

TEST(ExplicitEuler, IsStableBetweenTwoBoundsOfTheDamping) {
  const auto stable = [](double W, double s) { return reference::spectral_radius(method("explicit-euler"), {W, W, s}) <= 1; };
  for (const double W : {0.01, 0.5, 2.0, 3.9}) {
    EXPECT_TRUE(stable(W, W + 1e-6) && stable(W, 2 + W / 2 - 1e-6)) << W;
    EXPECT_FALSE(stable(W, W - 1e-6) || stable(W, 2 + W / 2 + 1e-6)) << W;
  }
  for (double s = 0; s < 10; s += 0.1) EXPECT_FALSE(stable(4.001, s)) << s;
}

/// Overdamped modes, whose λ are real.
TEST(StabilisedMethods, DoNotGrowOnTheRealAxis) {
  for (const char* name : {"rkl2", "rkc2"})
    for (const double s : {0.1, 1.0, 3.9, 10.0, 123.0, 2256.0, 1e5})
      for (const double part : {0.0, 0.01, 0.3, 0.99})
        EXPECT_LE(reference::spectral_radius(method(name), {0, part * s * s / 4, s}), 1 + 1e-9) << name << " with s = " << s;
}

TEST(StabilisedMethods, GrowWhereModesOscillateTooFast) {
  for (const char* name : {"rkl2", "rkc2"})
    for (const double s : {1.0, 20.0, 2000.0})
      EXPECT_GE(reference::spectral_radius(method(name), {0, 900 * s, s}), 1.1) << name;
}

TEST(Bridson, HasALimitThatDoesNotDependOnDamping) {
  for (const double c : {0.0, 0.1, 1.0, 10.0, 300.0}) EXPECT_NEAR(stability_limit(method("bridson"), {0, 1, c}), 2, 1e-4) << c;
}

TEST(Bridson, RingsWhereDampingIsStrong) {  // R(−∞) = −1: the trapezoidal rule
  const auto factors = reference::amplification_factors(method("bridson"), {0, 0.1, 1e4});
  EXPECT_NEAR(factors.back().real(), -1, 1e-3);
}

// --- Artificial inertia and damping -----------------------------------------------------------------------------------------

std::complex<double> exponent(const ModeBehaviour& b) { return {-b.decay, b.frequency}; }

/// The relative error of the predicted exponent μ against |μ|, along modes that become slower and slower.
Convergence prediction(std::string_view name, double W0, const std::function<Mode(double W)>& mode) {
  Convergence c;
  for (const double W : {W0, W0 / 4, W0 / 16, W0 / 64}) {
    const auto measured = exponent(measured_behaviour(method(name), mode(W)));
    c.steps.push_back(std::abs(measured));
    c.errors.push_back(std::abs(exponent(predicted_behaviour(name, mode(W))) / measured - 1.0));
  }
  return c;
}

/// Methods of a higher order have nothing artificial up to it.
int order_of_prediction(std::string_view name) { return std::max(2, method(name).order); }

TEST_P(Amplification, HasThePredictedInertiaAndDampingAsModesSlowDown) {
  const bool is_explicit = method(GetParam()).explicit_springs();
  const double nu = is_explicit ? 0 : 100;
  const int order = order_of_prediction(GetParam());
  const double W0 = is_explicit || order > 2 ? 0.1 : 0.2;  // from where on the order rules to where round-off does
  EXPECT_TRUE(has_order(prediction(GetParam(), W0, [=](double W) { return Mode{nu, W, 0}; }), order));
  EXPECT_TRUE(has_order(prediction(GetParam(), W0, [=](double W) { return Mode{nu, W, 0.3 * std::sqrt(W)}; }), order));
}

TEST_P(Amplification, HasThePredictedInertiaAndDampingAsStepsShrink) {
  EXPECT_TRUE(has_order(prediction(GetParam(), 0.01,
                                   [](double W) {
                                     return Mode{W, 0.3 * W, 0.1 * std::sqrt(W)};
                                   }),
                        order_of_prediction(GetParam())));
}

TEST(ArtificialInertia, MakesSbdf2LagInFigure33) {
  const double nu = 5e3;
  const Mode mode{nu, 1e-4 * nu, 0};
  const double exact = exact_behaviour(mode).frequency;
  EXPECT_NEAR(measured_behaviour(method("sbdf2"), mode).frequency / exact, 1 / std::sqrt(1 + (1 - 1e-4) * nu), 1e-5);
  EXPECT_NEAR(measured_behaviour(method("imex-midpoint"), mode).frequency / exact, 1 / std::sqrt(1 + nu / 4), 1e-5);
}

TEST(ArtificialDamping, OfImexEulerIsTheStepTimesKappa) {
  const Mode mode{1e-3, 1e-4, 0};
  EXPECT_NEAR(2 * measured_behaviour(method("imex-euler"), mode).decay, mode.nu, 1e-3 * mode.nu);
}

}  // namespace
}  // namespace drape::verify::amplification_test
