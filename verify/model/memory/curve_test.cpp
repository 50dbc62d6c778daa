// Measured curves of stress over strain: an edge's path against the curve's own definition, and sheets that move on branches.

#include "model/memory/curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/cloth.hpp"
#include "reference/sundials/cvode.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::curve_test {
namespace {

using model::Cloth;
using model::Polyline;
using model::Scene;
using model::StressCurve;
using small_problems::tight;
using solver::Outcome;
using solver::State;
using solver::Vectors;

const StressCurve soft_then_stiff{Polyline({{0, 0}, {0.02, 2}, {0.1, 42}}), {}};
const StressCurve with_loop{Polyline({{0, 0}, {0.05, 10}, {0.1, 30}}), Polyline({{0.2, 0}, {0.6, 0.15}, {1, 1}})};

TEST(Curve, HasItsPoints) {
  for (const auto& [strain, stress] : with_loop.loading.points()) EXPECT_DOUBLE_EQ(with_loop.stress(strain, strain), stress);
  EXPECT_DOUBLE_EQ(with_loop.stress(0.12, 0.12), 38);
  EXPECT_DOUBLE_EQ(with_loop.stress(-0.01, 0.1), -2);  // compression: the first slope
  EXPECT_DOUBLE_EQ(with_loop.stress(0.06, 0.1), 0.15 * 30);
  EXPECT_EQ(with_loop.stress(0.02, 0.1), 0);  // what remains
  EXPECT_EQ(with_loop.slope(0.01, 0.1), 0);
  EXPECT_DOUBLE_EQ(with_loop.slope(0.08, 0.1), 0.85 / 0.4 * 300);
  EXPECT_DOUBLE_EQ(with_loop.slope(0.08, 0.08), 400);
}

/// ∫ σ dε along straight pieces between the kinks of the curve, which the trapezoidal rule integrates exactly.
TEST(Curve, RecoversTheAreaBelowUnloading) {
  const double most = 0.1;
  double area = 0;
  const double kinks[] = {0, 0.02, 0.06, 0.1};
  for (int k = 1; k < 4; ++k)
    area += 0.5 * (with_loop.stress(kinks[k - 1], most) + with_loop.stress(kinks[k], most)) * (kinks[k] - kinks[k - 1]);
  EXPECT_NEAR(with_loop.recoverable(most, most), area, 1e-14);
  EXPECT_NEAR(soft_then_stiff.recoverable(0.1, 0.1), 0.5 * 0.02 * 2 + 0.5 * 0.08 * 44, 1e-14);
}

Scene strip(const StressCurve& curve) {
  Scene scene;
  scene.name = "strip";
  scene.sheet.grid = {.nu = 2, .nv = 1, .size_u = 0.2, .size_v = 0.05};
  scene.sheet.material.weft_curve = curve;
  scene.sheet.material.tension = {curve.loading.slope(0), 0};
  return scene;
}

/// 0 → ε1 → 0 → ε2 > ε1 → 0 in steps that do not end at the kinks.
TEST(Curve, IsFollowedByAnEdgeToRoundOff) {
  const Scene scene = strip(with_loop);
  const Cloth cloth = model::compile(scene);
  State y = cloth.start;
  double largest = 0, loop = 0, before = 0, strain = 0, last = 0;
  for (const double end : {0.07, 0.0, 0.1, 0.0})
    for (int n = 1; n <= 700; ++n) {
      const double now = before + (end - before) * n / 700;
      largest = std::max(largest, now);
      y.x(1, 0) = y.x(0, 0) + (1 + now) * scene.sheet.grid.size_u;
      Vectors f;
      cloth.ode.force(0, y.x, y.v, f);
      const double stress = f(0, 0) / scene.sheet.grid.size_v;
      ASSERT_NEAR(stress, with_loop.stress(now, largest), 1e-12 * 30) << now;
      loop += 0.5 * (last + stress) * (now - strain);
      strain = now, last = stress;
      cloth.ode.memory->carry(0, y);
      cloth.ode.memory->pass(0, y);
      if (n == 700) before = end;
    }
  // The first loop ends on the curve of loading, where the second leaves it.
  const double first = with_loop.loading.integral(0.07) - with_loop.recoverable(0.07, 0.07);
  const double second = with_loop.loading.integral(0.1) - with_loop.loading.integral(0.07) + with_loop.recoverable(0.07, 0.07) -
                        with_loop.recoverable(0.1, 0.1);
  EXPECT_NEAR(loop, first + second, 2e-4 * loop);
}

/// A sheet that is pulled into the second piece of its curve by its weight, and swings.
Scene sheet(const StressCurve& curve) {
  Scene scene;
  scene.name = "sheet";
  scene.sheet.grid = {.nu = 4, .nv = 4, .size_u = 0.3, .size_v = 0.3};
  scene.sheet.material.density = 0.4;
  scene.sheet.material.weft_curve = scene.sheet.material.warp_curve = curve;
  scene.sheet.material.tension = {curve.loading.slope(0), curve.loading.slope(0)};
  scene.sheet.material.shear = 5;
  scene.sheet.material.damping = {0.05, 0.05};
  scene.sheet.gravity = {0, 0, -9.81};
  scene.pins = {{.where = {}, .particles = {{0, 3}, {3, 3}}}};
  scene.end = 0.3;
  return scene;
}

std::int64_t count(const Cloth& cloth, const char* name) { return cloth.ode.work->counter(name, ""); }

TEST(Curve, RebuildsTheMatrixWhenASlopeChangesAndOnlyThen) {
  Scene scene = sheet(with_loop);
  for (const char* method : {"imex-euler", "implicit-euler", "midpoint"}) {
    const Cloth cloth = model::compile(scene);
    solver::Integrator integrator(cloth.ode, solver::method(method), {}, cloth.start);
    const std::int64_t changes = cloth.ode.memory->stiffness_changes();
    std::int64_t steps_with_change = 1;  // the first assembles
    for (int n = 0; n < 30; ++n) {
      const std::int64_t before = cloth.ode.memory->stiffness_changes();
      ASSERT_EQ(integrator.step(0.01).outcome, Outcome::success);
      cloth.ode.memory->pass(0, integrator.state());
      if (n < 29) steps_with_change += cloth.ode.memory->stiffness_changes() > before ? 1 : 0;
    }
    EXPECT_GT(cloth.ode.memory->stiffness_changes(), changes) << method;
    EXPECT_LT(steps_with_change, 30) << method;
    EXPECT_EQ(count(cloth, "matrix_builds"), steps_with_change) << method;
  }
  scene.sheet.material.weft_curve = scene.sheet.material.warp_curve = {Polyline({{0, 0}, {0.05, 10}}), {}};
  const Cloth cloth = model::compile(scene);
  solver::Integrator integrator(cloth.ode, solver::method("midpoint"), {}, cloth.start);
  EXPECT_EQ(integrate(integrator, 0.3, 0.01).outcome, Outcome::success);
  EXPECT_EQ(count(cloth, "matrix_builds"), 1);
}

/// One straight line is tension.
TEST(Curve, OfOneLineMovesAsTension) {
  Scene scene = sheet({Polyline({{0, 0}, {0.05, 10}}), {}});
  const Cloth curved = model::compile(scene);
  scene.sheet.material.weft_curve = scene.sheet.material.warp_curve = {};
  const Cloth straight = model::compile(scene);
  EXPECT_LT((Eigen::MatrixXd(curved.ode.stiffness) - Eigen::MatrixXd(straight.ode.stiffness)).norm(), 1e-10);
  for (const solver::Method& method : solver::methods()) {
    if (method.needs_energies || method.name.starts_with("xpbd") || method.name == "strain-limited") continue;
    State end[2];
    for (int k = 0; k < 2; ++k) {
      const Cloth& cloth = k == 0 ? curved : straight;
      solver::Integrator integrator(cloth.ode, method, tight(), cloth.start);
      EXPECT_EQ(integrate(integrator, 0.02, 0.002).outcome, Outcome::success) << method.name;
      end[k] = integrator.state();
    }
    EXPECT_LT((end[0].x - end[1].x).norm(), 1e-9) << method.name;
  }
}

/// With kinks errors fall by at least the first order; the same motion comes out of CVODE.
TEST(Curve, MovesASheetAsCvodeDoes) {
  for (const StressCurve& curve : {soft_then_stiff, with_loop}) {
    const Cloth cloth = model::compile(sheet(curve));
    const std::vector<double> times{0.3};
    const auto exact = reference::cvode_adams(cloth.ode, cloth.start, 0, times, {.rtol = 1e-9, .size = 0.3});
    for (const char* method : {"sbdf2", "bdf2", "midpoint", "verlet"}) {
      double before = 0;
      for (const int steps : {300, 1200}) {
        solver::Integrator integrator(cloth.ode, solver::method(method), tight(), cloth.start);
        EXPECT_EQ(integrate(integrator, 0.3, 0.3 / steps).outcome, Outcome::success);
        const double error = (integrator.state().x - exact.states[0].x).norm();
        EXPECT_LT(error, before == 0 ? 1e-2 : before / 3.5) << method;
        before = error;
      }
    }
  }
}

TEST(Curve, NeverGivesEnergy) {
  Scene scene = sheet(with_loop);
  scene.sheet.material.damping = {};
  const Cloth cloth = model::compile(scene);
  const auto energy = [&](const State& y) {
    return solver::kinetic_energy(cloth.ode, y.v) + solver::stored_energy(cloth.ode, 0, y);
  };
  solver::Integrator integrator(cloth.ode, solver::method("midpoint"), tight(), cloth.start);
  double before = energy(integrator.state());
  const double start = before;
  for (int n = 0; n < 600; ++n) {
    ASSERT_EQ(integrator.step(5e-4).outcome, Outcome::success);
    const double now = energy(integrator.state());
    EXPECT_LT(now, before + 1e-5) << n;
    before = now;
  }
  EXPECT_LT(before, start - 1e-3);
}

}  // namespace
}  // namespace drape::verify::curve_test
