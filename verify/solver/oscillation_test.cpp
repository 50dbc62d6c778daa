// A compiled sheet that oscillates in one of its modes: frequency and decay against theory and against the amplification of
// each method.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "reference/sundials/cvode.hpp"
#include "reference/theory/amplification.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/pinned_sheet.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::oscillation_test {
namespace {

using reference::LinearMode;
using reference::PinnedSheet;
using reference::SheetMode;
using solver::Method;
using solver::method;
using solver::State;
using solver::Vectors;

/// A sheet that oscillates in one of its modes so little that it is linear.
struct Oscillation {
  PinnedSheet sheet;
  SheetMode mode;
  double amplitude = 2e-5;  ///< [m]

  LinearMode linear() const { return linear_mode(sheet, mode); }
  Vectors shape() const { return mode_shape(sheet, mode); }
  model::Cloth cloth() const {
    model::Cloth result = model::compile(scene_of(sheet));
    result.start.x += amplitude * shape();
    return result;
  }
};

/// μ of x ~ Re exp(μ t), fitted to samples of the mode in the second half: x_{n+2} + a x_{n+1} + b x_n = 0 by least squares.
std::complex<double> fitted_exponent(const Oscillation& o, const std::vector<State>& y, double h) {
  const Vectors rest = start(scene_of(o.sheet)).x, shape = o.shape();
  const auto n = std::ssize(y);
  const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(
      n - n / 2, [&](Eigen::Index k) { return (y[n / 2 + k].x - rest).cwiseProduct(shape).sum() / o.amplitude; });
  Eigen::MatrixXd A(x.size() - 2, 2);
  A << x.segment(1, x.size() - 2), x.head(x.size() - 2);
  const Eigen::Vector2d c = A.colPivHouseholderQr().solve(-x.tail(x.size() - 2));
  return std::log(-c[0] / 2 + std::sqrt(std::complex<double>(c[0] * c[0] / 4 - c[1]))) / h;
}

std::complex<double> exponent(const reference::ModeBehaviour& b, double h) { return {-b.decay / h, b.frequency / h}; }

class OscillationBy : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, OscillationBy, testing::ValuesIn(small_problems::names(solver::thesis_methods())),
                         [](const auto& test) { return small_problems::identifier(test.param); });

constexpr SheetMode modes[] = {{2, 1, reference::Motion::transverse}, {1, 2, reference::Motion::along_v}};

/// With plate and linear damping: all that the split treats implicitly.
PinnedSheet damped_sheet() {
  PinnedSheet s = tense_sheet();
  s.B1 = 4e-3, s.B2 = 3e-3, s.plate_projected = false;
  s.d1 = 0.03, s.d2 = 0.02;
  return s;
}

TEST(OscillationByCvode, DecaysAsInTheory) {
  for (const SheetMode& mode : modes) {
    Oscillation o{damped_sheet(), mode};
    o.sheet.dB1 = 1e-4, o.sheet.dB2 = 2e-4;
    const model::Cloth cloth = o.cloth();
    const double c = o.linear().damping, h = 0.3 / std::sqrt(o.linear().omega_squared);
    std::vector<double> times(60);
    std::ranges::generate(times, [&, k = 0]() mutable { return h * ++k; });
    const auto trajectory = reference::cvode(cloth.ode, cloth.start, 0, times, {.rtol = 1e-12, .size = o.amplitude});
    const std::complex<double> mu = fitted_exponent(o, trajectory.states, h);
    const double frequency = std::sqrt(o.linear().omega_squared - c * c / 4);
    EXPECT_NEAR(mu.real(), -c / 2, 1e-6 * frequency);
    EXPECT_NEAR(mu.imag(), frequency, 1e-6 * frequency);
  }
}

TEST_P(OscillationBy, DecaysAsInTheoryToTheOrderOfTheMethod) {
  const Method& m = method(GetParam());
  for (const SheetMode& mode : modes) {
    const Oscillation o{damped_sheet(), mode};
    const model::Cloth cloth = o.cloth();
    const std::complex<double> exact = exponent(exact_behaviour(at_step(o.linear(), 1)), 1);
    Convergence c;
    for (const int n : {80, 160, 320, 640}) {
      const double h = 2 * std::numbers::pi / exact.imag() / n;
      const std::complex<double> mu = fitted_exponent(o, run(cloth, m, h, n), h);
      const std::complex<double> of_one_step = exponent(measured_behaviour(m, at_step(o.linear(), h)), h);
      EXPECT_LE(std::abs(mu - of_one_step), 1e-5 * std::abs(exact)) << "with " << n << " steps a period";
      c.steps.push_back(h);
      c.errors.push_back(std::abs(mu - exact));
    }
    EXPECT_TRUE(has_order(c, m.order)) << "mode " << mode.m << " x " << mode.n;
  }
}

constexpr int period = 40;  ///< [steps]

/// The step with which the method moves the mode periodically.
double step_of_period(const Method& m, const LinearMode& mode) {
  double below = 0, above = 4 * std::numbers::pi / period / std::sqrt(mode.omega_squared);
  while (above - below > 1e-14 * above) {
    const double h = (below + above) / 2;
    (measured_behaviour(m, at_step(mode, h)).frequency < 2 * std::numbers::pi / period ? below : above) = h;
  }
  return below;
}

/// The decay of the amplitude a step that an undamped mode has for no other reason than the method, to leading order.
double leading_decay(const Method& m, const reference::Mode& mode) {
  const double theta = 2 * std::numbers::pi / period, of_two_steps = m.history == 2 ? std::pow(theta, 4) / 4 : 0;
  return predicted_behaviour(m.name, mode).decay + of_two_steps;
}

TEST_P(OscillationBy, DriftsWithoutDampingAsTheAmplificationSays) {
  const Method& m = method(GetParam());
  for (const SheetMode& mode : modes) {
    Oscillation o{damped_sheet(), mode};
    o.sheet.d1 = o.sheet.d2 = 0;
    const model::Cloth cloth = o.cloth();
    const double h = step_of_period(m, o.linear()), rest = cloth.ode.potential_energy(0, start(scene_of(o.sheet)).x);
    const auto E = energies(cloth, m, h, 2 * period);
    const int n = m.history == 2 ? period : 0;  // what the first step left has died away after a period
    const double measured = std::log((E[n] - rest) / (E[n + period] - rest)) / (2 * period);
    const reference::Mode at_h = at_step(o.linear(), h);
    EXPECT_NEAR(measured, measured_behaviour(m, at_h).decay, 1e-5 * measured + 2e-8);
    EXPECT_NEAR(measured, leading_decay(m, at_h), 0.1 * leading_decay(m, at_h) + 2e-8);
  }
}

}  // namespace
}  // namespace drape::verify::oscillation_test
