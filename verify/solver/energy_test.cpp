// What becomes of the energy of a compiled sheet that moves far from rest: kept, dissipated, or lost by the method itself.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "verify/support/convergence.hpp"
#include "verify/support/pinned_sheet.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::energy_test {
namespace {

using solver::Method;
using solver::method;
using solver::SplitOde;
using solver::State;
using solver::Vectors;

/// All forces that have energies, and a start from which the sheet moves far: transversally by a quarter of its length.
model::Cloth wild(bool damped) {
  const reference::PinnedSheet tense = tense_sheet();
  model::Scene scene = scene_of(tense);
  model::Material& m = scene.sheet.material;
  m.shear = 8, m.contraction = 9;
  m.bend = {4e-3, 3e-3}, m.bend_projected = false;
  if (damped) m.damping = {0.03, 0.02}, m.shear_damping = 0.02, m.bend_damping = {1e-5, 2e-5};
  scene.sheet.gravity = {1, -2, -5};
  model::Cloth cloth = model::compile(scene);
  cloth.start.v = 6 * mode_shape(tense, {1, 1, reference::Motion::transverse}) +
                  mode_shape(tense, {2, 1, reference::Motion::along_u}) + mode_shape(tense, {1, 3, reference::Motion::along_v});
  return cloth;
}

TEST(Midpoint, KeepsTheEnergyOfASheetToSecondOrder) {
  const model::Cloth cloth = wild(false);
  Convergence c;
  for (const int n : {100, 200, 400, 800}) {
    const auto E = energies(cloth, method("midpoint"), 0.3 / n, n);
    const auto [least, most] = std::ranges::minmax(E);
    c.steps.push_back(0.3 / n);
    c.errors.push_back(most - least);
  }
  EXPECT_TRUE(has_order(c, 2));
}

/// How much less energy there is on average in the last quarter of a long run than in the first, and the range of the first.
struct Drift {
  double loss, range;
};
Drift drift(const char* name) {
  const auto E = energies(wild(false), method(name), 2e-3, 4000);
  const Eigen::ArrayXd all = Eigen::ArrayXd::Map(E.data(), std::ssize(E)), first = all.head(1000), last = all.tail(1000);
  return {first.mean() - last.mean(), first.maxCoeff() - first.minCoeff()};
}

TEST(Midpoint, DoesNotLetTheEnergyOfASheetDrift) {
  const auto [loss, range] = drift("midpoint");
  EXPECT_LE(std::abs(loss), 0.1 * range);
}

TEST(Bdf2, LetsTheEnergyOfASheetDrift) {
  DRAPE_SLOW();
  const auto [loss, range] = drift("bdf2");
  EXPECT_GE(loss, range);
}

/// The largest gain of energy in a step, relative to the energy.
double largest_gain(const model::Cloth& cloth, const char* name, double h, int n) {
  const auto E = energies(cloth, method(name), h, n);
  double gain = -INFINITY;
  for (std::size_t k = 0; k + 1 < E.size(); ++k) gain = std::max(gain, (E[k + 1] - E[k]) / E.front());
  return gain;
}

TEST(ImplicitEuler, LosesEnergyInEveryStep) {
  for (const bool damped : {false, true})
    for (const double h : {1e-4, 1e-3, 1e-2, 0.1})
      EXPECT_LE(largest_gain(wild(damped), "implicit-euler", h, 50), 1e-12) << "h = " << h << ", damped: " << damped;
}

TEST(Midpoint, DoesNotLoseEnergyInEveryStep) { EXPECT_GE(largest_gain(wild(false), "midpoint", 1e-2, 50), 1e-6); }

/// −<v, viscous force> [W], the viscous force being what velocities add.
double dissipated_power(const SplitOde& ode, const State& y) {
  Vectors moving(y.x.rows(), 3), still(y.x.rows(), 3);
  ode.force(0, y.x, y.v, moving);
  ode.force(0, y.x, 0 * y.v, still);
  return (still - moving).cwiseProduct(y.v).sum();
}

/// Energy lost minus the integral of the dissipated power by the trapezoidal rule.
double imbalance(const model::Cloth& cloth, const Method& method, double h, int n) {
  const std::vector<State> y = run(cloth, method, h, n);
  double work = 0;
  for (int k = 0; k < n; ++k) work += h / 2 * (dissipated_power(cloth.ode, y[k]) + dissipated_power(cloth.ode, y[k + 1]));
  return energy(cloth.ode, y.front()) - energy(cloth.ode, y.back()) - work;
}

class EnergyOfEveryMethod : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, EnergyOfEveryMethod, testing::ValuesIn(small_problems::names(solver::thesis_methods())),
                         [](const auto& test) { return small_problems::identifier(test.param); });

TEST_P(EnergyOfEveryMethod, IsLostAsMuchAsIsDissipatedToTheOrderOfTheMethod) {
  DRAPE_SLOW();
  const Method& m = method(GetParam());
  const model::Cloth cloth = wild(true);
  Convergence c;
  for (const int n : {400, 600, 900, 1350}) {
    c.steps.push_back(0.05 / n);
    c.errors.push_back(std::abs(imbalance(cloth, m, 0.05 / n, n)));
  }
  EXPECT_TRUE(has_order(c, m.order));
}

}  // namespace
}  // namespace drape::verify::energy_test
