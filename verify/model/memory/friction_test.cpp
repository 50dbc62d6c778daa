// Friction between yarns and measured curves of shear and bending: laws against closed forms, sheets against CVODE.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "model/cloth.hpp"
#include "model/memory/stress_law.hpp"
#include "model/sheet/strain.hpp"
#include "reference/sundials/cvode.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::friction_test {
namespace {

using model::Cloth;
using model::CurveLaw;
using model::DahlLaw;
using model::FrictionKind;
using model::JenkinLaw;
using model::Polyline;
using model::Scene;
using model::StressCurve;
using model::StressLaw;
using small_problems::tight;
using solver::Outcome;
using solver::State;
using solver::Vectors;

constexpr double limit = 2, onset = 0.3;

const StressCurve with_loop{Polyline({{0, 0}, {0.5, 1}, {2, 6}}), Polyline({{0.1, 0}, {0.6, 0.3}, {1, 1}})};

std::vector<std::unique_ptr<StressLaw>> laws() {
  std::vector<std::unique_ptr<StressLaw>> all;
  all.push_back(std::make_unique<JenkinLaw>(limit, onset));
  all.push_back(std::make_unique<DahlLaw>(limit, onset));
  all.push_back(std::make_unique<CurveLaw>(with_loop, true, 0));
  all.push_back(std::make_unique<CurveLaw>(with_loop.smoothed(), true, 0));
  return all;
}

/// ∫ σ dε and z at the end of a straight path.
struct Path {
  double work, z;
};
Path follow(const StressLaw& law, double from, double to, double z) {
  constexpr int pieces = 2000;
  double work = 0, before = law.stress(from, from, z).value;
  for (int k = 1; k <= pieces; ++k) {
    const double now = law.stress(from + (to - from) * k / pieces, from, z).value;
    work += 0.5 * (before + now) * (to - from) / pieces;
    before = now;
  }
  return {work, law.carry(to, from, z)};
}

/// Between ±a the loop of a Jenkin element is a parallelogram, that of a Dahl element what its differential equation says.
TEST(Friction, LosesTheAreaOfItsLoop) {
  const double a = 1.3;
  const auto loss = [&](const StressLaw& law) {
    double z = 0, at = 0, work = 0;
    for (const double to : {a, -a, a, -a, a}) {
      const Path path = follow(law, at, to, z);
      work = to > at ? work + path.work : path.work;  // the last two make a loop
      z = path.z, at = to;
    }
    return work;
  };
  EXPECT_NEAR(loss(JenkinLaw(limit, onset)), 4 * limit * (a - onset), 1e-3);
  const double F = limit * std::tanh(a / onset);  // at the ends of a closed loop
  EXPECT_NEAR(loss(DahlLaw(limit, onset)), 4 * limit * a - 2 * onset * (F + limit) * -std::expm1(-2 * a / onset), 1e-3);
}

TEST(Friction, OfDahlIsTheSameInOneStepAndInMany) {
  const DahlLaw law(limit, onset);
  double z = 0.4, at = 0;
  for (int k = 1; k <= 100; ++k) {
    z = law.carry(-0.02 * k, at, z);
    at = -0.02 * k;
  }
  EXPECT_NEAR(z, law.carry(-2, 0, 0.4), 1e-13);
  EXPECT_LT(std::abs(z), limit);
}

TEST(StressLaw, HasTheSlopeThatDifferencesShow) {
  for (const auto& law : laws())
    for (const double strain : {-1.7, -0.41, 0.13, 0.83, 1.9})
      for (const double z : {0.0, 1.1}) {
        const double step = 1e-6, from = 0.3;
        const double rise = law->stress(strain + step, from, z).value - law->stress(strain - step, from, z).value;
        EXPECT_NEAR(law->stress(strain, from, z).slope, rise / (2 * step), 1e-6);
      }
}

/// On every straight path: what is done to a strain, less what is stored of it.
TEST(StressLaw, NeverGivesEnergy) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> somewhere(-2, 2);
  for (const auto& law : laws()) {
    double z = 0, at = 0, lost = 0;
    for (int k = 0; k < 40; ++k) {
      const double to = somewhere(generator);
      const Path path = follow(*law, at, to, z);
      const double dissipated = path.work - (law->energy(to, path.z) - law->energy(at, z));
      EXPECT_GT(dissipated, -1e-5);
      lost += dissipated;
      z = path.z, at = to;
    }
    EXPECT_GT(lost, 0.1);
  }
}

/// dz/dt against what a short step changes, in both directions.
TEST(StressLaw, HasTheRateThatShortStepsShow) {
  for (const auto& law : laws())
    for (const double rate : {-0.7, 0.9})
      for (const double z : {0.6, 1.4}) {
        const double strain = z * (rate < 0 ? -1 : 1), dt = 1e-6;
        EXPECT_NEAR((law->carry(strain + rate * dt, strain, z) - z) / dt, law->rate(strain, rate, z), 1e-4);
      }
}

TEST(SmoothCurve, GoesThroughItsPointsWithoutKinks) {
  const Polyline points({{0, 0}, {0.02, 1}, {0.05, 20}, {0.06, 20}, {0.1, 60}}), smooth = points.smoothed();
  for (const auto& [x, y] : points.points()) EXPECT_NEAR(smooth.value(x), y, 1e-12);
  double integral = 0;
  for (int k = -20; k < 1200; ++k) {
    const double x = 1e-4 * k, step = 1e-4;
    EXPECT_GE(smooth.value(x + step), smooth.value(x) - 1e-12) << "monotonic";
    EXPECT_NEAR(smooth.slope(x + 1e-9), smooth.slope(x - 1e-9), 1e-3);
    EXPECT_NEAR((smooth.value(x + 1e-7) - smooth.value(x - 1e-7)) / 2e-7, smooth.slope(x), 1e-2);
    if (x >= 0) integral += step / 6 * (smooth.value(x) + 4 * smooth.value(x + step / 2) + smooth.value(x + step));
  }
  EXPECT_NEAR(smooth.integral(0.12), integral, 1e-12);
  EXPECT_NEAR(points.smoothed().chord_slope(0.03), 19 / 0.03, 1e-10);
}

/// A sheet hung by its left edge that bends and shears under its weight.
Scene hanging() {
  Scene scene;
  scene.name = "hanging";
  scene.sheet.grid = {.nu = 6, .nv = 4, .size_u = 0.3, .size_v = 0.18};
  model::Material& m = scene.sheet.material;
  m.density = 0.2;
  m.tension = {100, 80};
  m.shear = 4;
  m.bend = {2e-4, 2e-4};
  m.bend_projected = false;
  m.damping = {0.02, 0.02};
  scene.sheet.gravity = {3, -4, -8};
  scene.pins = {{.where = "left edge", .particles = {}}};
  scene.end = 0.2;
  return scene;
}

std::vector<std::pair<std::string, Scene>> sheets_with_memory() {
  std::vector<std::pair<std::string, Scene>> all;
  for (const FrictionKind law : {FrictionKind::dahl, FrictionKind::jenkin}) {
    Scene scene = hanging();
    scene.sheet.material.friction = {.law = law, .shear = 0.3, .shear_onset = 0.02, .bend = {2e-3, 1e-3}, .bend_onset = 4};
    all.emplace_back(law == FrictionKind::dahl ? "dahl" : "jenkin", scene);
  }
  Scene curves = hanging();
  model::Material& m = curves.sheet.material;
  m.shear_curve = {Polyline({{0, 0}, {0.02, 0.08}, {0.2, 1.5}}), Polyline({{0.1, 0}, {0.7, 0.4}, {1, 1}})};
  m.weft_bend_curve = {Polyline({{0, 0}, {3, 6e-4}, {30, 3e-3}}), {}};
  all.emplace_back("curves", curves);
  return all;
}

TEST(SheetWithHysteresis, MovesAsCvodeSays) {
  DRAPE_SLOW();
  for (const auto& [name, scene] : sheets_with_memory()) {
    const Cloth cloth = model::compile(scene);
    const std::vector<double> times{scene.end};
    const auto exact = reference::cvode_adams(cloth.ode, cloth.start, 0, times, {.rtol = 1e-9, .size = 0.3});
    for (const char* method : {"sbdf2", "bdf2", "midpoint", "verlet"}) {
      double before = 0;
      for (const int steps : {100, 400}) {
        solver::Integrator integrator(cloth.ode, solver::method(method), tight(), cloth.start);
        EXPECT_EQ(integrate(integrator, scene.end, scene.end / steps).outcome, Outcome::success);
        const double error = (integrator.state().x - exact.states[0].x).norm();
        EXPECT_LT(error, before == 0 ? 0.1 : before / 3.5) << name << " " << method;
        before = error;
      }
    }
  }
}

/// Where a sheet stands, its Jacobian is that of the side to which it moves: backwards the slopes of loops are others.
TEST(SheetWithHysteresis, HasTheJacobianOfTheWayItGoes) {
  for (const auto& [name, scene] : sheets_with_memory()) {
    const Cloth cloth = model::compile(scene);
    State y = cloth.start;
    y.x += sheets::random_vectors(cloth.ode.particles(), 2e-3, 4);
    cloth.ode.memory->begin(1, 0, cloth.start);
    cloth.ode.memory->carry(0.1, y);
    cloth.ode.memory->pass(0.1, y);
    const Vectors way = sheets::random_vectors(cloth.ode.particles(), 1, 5);
    for (const double sign : {1.0, -1.0}) {
      constexpr double step = 1e-8;
      const Vectors v = sign * way;
      solver::SparseMatrix dx, dv;
      cloth.ode.jacobian(0.1, y.x, v, dx, dv);
      Vectors before, after, at_rest = Vectors::Zero(v.rows(), 3);
      cloth.ode.force(0.1, y.x, at_rest, before);
      cloth.ode.force(0.1, y.x + step * v, at_rest, after);
      const Eigen::VectorXd change = Eigen::Map<const Eigen::VectorXd>(after.data(), after.size()) -
                                     Eigen::Map<const Eigen::VectorXd>(before.data(), before.size());
      const Eigen::VectorXd expected = dx * Eigen::Map<const Eigen::VectorXd>(v.data(), v.size());
      EXPECT_LT((change / step - expected).norm(), 1e-4 * expected.norm()) << name << sign;
    }
  }
}

/// K has the slopes of tension, not those of shear and bending.
TEST(SheetWithHysteresis, NeverRebuildsItsMatrix) {
  for (const auto& [name, scene] : sheets_with_memory()) {
    const Cloth cloth = model::compile(scene);
    solver::Integrator integrator(cloth.ode, solver::method("midpoint"), {}, cloth.start);
    EXPECT_EQ(integrate(integrator, 0.1, 0.01).outcome, Outcome::success);
    EXPECT_EQ(cloth.ode.work->counter("matrix_builds", ""), 1) << name;
    EXPECT_GT(cloth.plan.internal_variables, 0);
  }
}

TEST(SheetWithHysteresis, NeverGainsEnergy) {
  for (auto [name, scene] : sheets_with_memory()) {
    scene.sheet.material.damping = {};
    const Cloth cloth = model::compile(scene);
    const auto energy = [&](const State& y) {
      return solver::kinetic_energy(cloth.ode, y.v) + solver::stored_energy(cloth.ode, 0, y);
    };
    solver::Integrator integrator(cloth.ode, solver::method("midpoint"), tight(), cloth.start);
    const double start = energy(integrator.state());
    double before = start;
    for (int n = 0; n < 400; ++n) {
      ASSERT_EQ(integrator.step(5e-4).outcome, Outcome::success) << name;
      const double now = energy(integrator.state());
      EXPECT_LT(now, before + 1e-6) << name << n;
      before = now;
    }
    EXPECT_LT(before, start - 1e-5) << name;
  }
}

/// One straight line has no memory.
TEST(SheetWithCurves, OfOneLineMovesAsWithModuli) {
  Scene scene = hanging();
  const Cloth plain = model::compile(scene);
  scene.sheet.material.shear_curve = {Polyline({{0, 0}, {0.5, 2}}), {}};
  scene.sheet.material.weft_bend_curve = scene.sheet.material.warp_bend_curve = {Polyline({{0, 0}, {10, 2e-3}}), {}};
  const Cloth curved = model::compile(scene);
  State end[2];
  for (int k = 0; k < 2; ++k) {
    const Cloth& cloth = k == 0 ? plain : curved;
    solver::Integrator integrator(cloth.ode, solver::method("midpoint"), tight(), cloth.start);
    EXPECT_EQ(integrate(integrator, 0.1, 0.005).outcome, Outcome::success);
    end[k] = integrator.state();
  }
  EXPECT_LT((end[0].x - end[1].x).norm(), 1e-10);
}

/// A strip that is bent to a cylinder and let go keeps the curvature HB/B, 2HB/2B as Kawabata's test reads it: there its
/// friction holds what its stiffness pulls.
TEST(Friction, KeepsTheCurvatureOfKawabatasTest) {
  constexpr double B = 1e-4, HB = 2e-3;
  Scene scene;
  scene.sheet.grid = {.nu = 9, .nv = 3, .size_u = 0.08, .size_v = 0.02};
  model::Material& m = scene.sheet.material;
  m.density = 0.1;
  m.tension = {200, 200};
  m.shear = 50;
  m.bend = {B, 0};
  m.bend_damping = {1e-6, 1e-6};
  m.bend_projected = false;
  m.damping = {0.1, 0.1};
  m.friction = {.law = FrictionKind::jenkin, .bend = {HB, 0}, .bend_onset = 2};
  const Cloth cloth = model::compile(scene);
  State y = cloth.start;
  y.x = sheets::cylinder(scene.sheet.grid, 80);
  cloth.ode.memory->begin(1, 0, cloth.start);
  cloth.ode.memory->carry(1e-3, y);
  solver::Integrator integrator(cloth.ode, solver::method("implicit-euler"), {}, y);
  ASSERT_EQ(integrate(integrator, 50, 1e-2).outcome, Outcome::success);
  const double kappa = model::Strain::of_curvature(model::Metric(scene.sheet.grid), 4, 1, true).value(integrator.state().x);
  EXPECT_NEAR(kappa, HB / B, 0.02 * HB / B);
}

}  // namespace
}  // namespace drape::verify::friction_test
