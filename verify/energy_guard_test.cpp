// The most energy that a scene can have: reached by free fall, never exceeded by healthy runs, and found out by unstable ones.

#include "model/energy_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/scene_file.hpp"

namespace drape::verify::energy_guard_test {
namespace {

using model::Cloth;
using model::EnergyGuard;
using model::Scene;
using solver::Outcome;

Scene hung_sheet(double tension) {
  Scene scene = model::load_scene("hung-corners");
  scene.sheet.grid.nu = scene.sheet.grid.nv = 6;
  scene.sheet.material.tension = {tension, tension};
  scene.sheet.material.damping = {};
  return scene;
}

/// The largest energy over the limit in a run.
double largest_part(const Scene& scene, const char* method, double until, double h) {
  const Cloth cloth = model::compile(scene);
  const EnergyGuard guard(scene, cloth);
  solver::Integrator integrator(cloth.ode, solver::method(method), {}, cloth.start);
  double largest = 0;
  const auto result = integrate(integrator, until, h, [&](const solver::StepReport& step) {
    const double kinetic = solver::kinetic_energy(cloth.ode, step.y.v);
    const double energy = guard.energy(kinetic, cloth.ode.potential_energy(step.t, step.y.x), step.y.x);
    largest = std::max(largest, energy / guard.limit(step.t));
  });
  EXPECT_EQ(result.outcome, Outcome::success) << scene.name << ": " << result.message;
  return largest;
}

TEST(EnergyGuard, IsReachedByFreeFall) {
  Scene scene = hung_sheet(1e3);
  scene.pins.clear();
  EXPECT_NEAR(largest_part(scene, "midpoint", 0.1, 0.01), 1, 1e-5);
  scene.start.velocity = {0, 0, -3};
  EXPECT_NEAR(largest_part(scene, "midpoint", 0.1, 0.01), 1, 1e-5);
  scene.start.velocity = {0, 0, 3};
  EXPECT_LT(largest_part(scene, "midpoint", 0.1, 0.01), 1) << "it falls after it has risen";
}

TEST(EnergyGuard, KnowsTheElasticEnergyOfTheStart) {
  Scene scene = hung_sheet(1e3);
  scene.sheet.gravity.setZero();
  scene.start.stretch = {1.5, 1.5};
  const double part = largest_part(scene, "verlet", 0.05, 1e-4);
  EXPECT_GT(part, 0.99);
  EXPECT_LT(part, 1.01);
}

TEST(EnergyGuard, IsNotExceededByABuiltinScene) {
  for (const model::BuiltinScene& builtin : model::builtin_scenes()) {
    Scene scene = model::load_scene(std::string(builtin.name));
    if (scene.name == "peer-edge") scene.sheet.grid.nu = scene.sheet.grid.nv = 20;  // undamped and fine: dear
    EXPECT_LT(largest_part(scene, "bdf2", 0.1, 0.01), 1.01) << builtin.name;
  }
}

TEST(EnergyGuard, IsNotExceededByASheetAtRest) {
  Scene scene = hung_sheet(1e6);
  scene.sheet.gravity.setZero();
  EXPECT_LT(largest_part(scene, "bdf2", 0.2, 0.01), 1);
  scene.pins.front().velocity = {0.3, 0, 0};
  EXPECT_LT(largest_part(scene, "bdf2", 0.2, 0.01), 1) << "moved";
}

/// A run of verlet with sub-steps of a part of their stability limit.
solver::RunResult explicit_run(double fraction, double until) {
  const Scene scene = hung_sheet(1e4);
  const Cloth cloth = model::compile(scene);
  solver::Options options;
  options.verlet_fraction = fraction;
  solver::Integrator integrator(cloth.ode, solver::method("verlet"), options, cloth.start);
  const EnergyGuard guard(scene, cloth);
  int seen = 0;
  const auto result = integrate(integrator, cloth.ode, guard, until, 0.01, [&](const solver::StepReport& step) {
    ++seen;
    EXPECT_LE(solver::kinetic_energy(cloth.ode, step.y.v), 10 * guard.limit(step.t)) << "steps beyond it are not shown";
  });
  EXPECT_EQ(result.steps, seen);
  return result;
}

TEST(EnergyGuard, LetsAHealthyRunPass) {
  const auto result = explicit_run(0.9, 0.3);
  EXPECT_EQ(result.outcome, Outcome::success);
  EXPECT_EQ(result.message, "");
  EXPECT_NEAR(result.last_good_time, 0.3, 1e-12);
}

TEST(EnergyGuard, EndsAnExplicitRunBeyondItsLimit) {
  const auto result = explicit_run(1.1, 3);
  EXPECT_EQ(result.outcome, Outcome::unstable);
  EXPECT_THAT(result.message, testing::HasSubstr("J where the scene can have"));
  EXPECT_LT(result.last_good_time, 0.2) << "long before its numbers overflow";
  EXPECT_NEAR(result.last_good_time, 0.01 * result.steps, 1e-12) << "the step before";
}

TEST(EnergyGuard, IsExceededByWhatIsNoNumber) {
  const Scene scene = hung_sheet(1e4);
  const EnergyGuard guard(scene, model::compile(scene));
  EXPECT_TRUE(guard.exceeded(1, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(guard.exceeded(1, 10.1 * guard.limit(1)));
  EXPECT_FALSE(guard.exceeded(1, 9.9 * guard.limit(1)));
}

}  // namespace
}  // namespace drape::verify::energy_guard_test
