// The energy that a scene can have: reached by free fall, never exceeded by healthy runs, and found out by unstable ones.

#include "bench/runs/energy_guard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bench/runs/run.hpp"
#include "model/phases.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::energy_guard_test {
namespace {

using bench::EnergyGuard;
using model::Cloth;
using model::Scene;
using solver::Outcome;

Scene hung_sheet(double tension) {
  Scene scene = model::load_scene("hung-corners");
  scene.sheet.grid.nu = scene.sheet.grid.nv = 6;
  scene.sheet.material.tension = {tension, tension};
  scene.sheet.material.damping = {};
  return scene;
}

/// The part of its limit that the energy of a sheet has which loses none.
constexpr double lossless = 1 / (1 + EnergyGuard::tolerated);

/// The largest energy over the limit in a run.
double largest_part(const Scene& scene, const char* method, double until, double h) {
  const Cloth cloth = model::compile(scene);
  EnergyGuard guard(model::phases(scene).front(), cloth);
  solver::Integrator integrator(cloth.ode, solver::method(method), {}, cloth.start);
  double largest = 0;
  const auto result = integrate(integrator, until, h, [&](const solver::StepReport& step) {
    EXPECT_EQ(guard.exceeded(step), guard.energy() > guard.limit());
    largest = std::max(largest, guard.energy() / guard.limit());
  });
  EXPECT_EQ(result.outcome, Outcome::success) << scene.name << ": " << result.message;
  return largest;
}

bench::RunSpec spec_of(const Scene& scene, const char* method, double until, double h) {
  bench::RunSpec spec{scene, "", &solver::method(method), h, {}};
  spec.scene.end = until;
  return spec;
}

solver::RunResult guarded(const Scene& scene, const char* method, double until, double h) {
  bench::EnergyGuardObserver guard;
  bench::Observer* const observers[] = {&guard};
  return bench::run(spec_of(scene, method, until, h), model::compile(scene), observers).result;
}

TEST(EnergyGuard, IsReachedByFreeFall) {
  Scene scene = hung_sheet(1e3);
  scene.pins.clear();
  const auto part = [](double speed) {  // of the limit, falling for 0.1 s; three steps are 0.03 s
    const double energy = 0.5 * std::pow(speed + 0.1 * 9.81, 2), first = 0.5 * std::pow(0.03 * 9.81, 2);
    return energy / (energy / lossless + first);
  };
  EXPECT_NEAR(largest_part(scene, "midpoint", 0.1, 0.01), part(0), 1e-5);
  scene.start.velocity = {0, 0, -3};
  EXPECT_NEAR(largest_part(scene, "midpoint", 0.1, 0.01), part(3), 1e-5);
  scene.start.velocity = {0, 0, 3};
  EXPECT_LT(largest_part(scene, "midpoint", 0.1, 0.01), lossless) << "it falls after it has risen";
}

TEST(EnergyGuard, KnowsTheElasticEnergyOfTheStart) {
  Scene scene = hung_sheet(1e3);
  scene.sheet.gravity.setZero();
  scene.start.stretch = {1.5, 1.5};
  EXPECT_NEAR(largest_part(scene, "verlet", 0.05, 1e-4), lossless, 0.01);
}

TEST(EnergyGuard, IsNotExceededByABuiltinScene) {
  DRAPE_SLOW();
  for (const model::BuiltinScene& builtin : model::builtin_scenes()) {
    Scene scene = model::load_scene(std::string(builtin.name));
    if (scene.name == "peer-edge") scene.sheet.grid.nu = scene.sheet.grid.nv = 20;  // undamped and fine: dear
    EXPECT_LT(largest_part(scene, "bdf2", 0.1, 0.01), 1) << builtin.name;
  }
}

TEST(EnergyGuard, IsNotExceededByASheetAtRest) {
  DRAPE_SLOW();
  Scene scene = hung_sheet(1e6);
  scene.sheet.gravity.setZero();
  EXPECT_LT(largest_part(scene, "bdf2", 0.2, 0.01), 1);
  scene.pins.front().velocity = {0.3, 0, 0};
  EXPECT_LT(largest_part(scene, "bdf2", 0.2, 0.01), 1) << "moved";
}

/// Sheets whose bending, which has no energy, is all that moves them at first.
std::vector<Scene> released() {
  std::vector<Scene> all;
  Scene curtain = model::load_scene("curtain");
  curtain.start.velocity.setZero();
  curtain.sheet.material.bend = {1e-2, 1e-2};
  all.push_back(curtain);
  curtain.sheet.gravity.setZero();
  curtain.sheet.material.bend_form = model::BendForm::membrane;
  curtain.sheet.material.bend = {1, 1};
  all.push_back(curtain);
  Scene wind = model::load_scene("wind");
  wind.sheet.material.bend = {2e-2, 2e-2};
  all.push_back(wind);
  Scene sheared = model::load_scene("hung-corners");
  sheared.sheet.material.shear_form = model::ShearForm::printed;
  sheared.sheet.material.damping = {};
  all.push_back(sheared);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].name += std::to_string(k);
  return all;
}

TEST(EnergyGuard, KnowsTheWorkOfForcesWithoutAnEnergy) {
  DRAPE_SLOW();
  for (const Scene& scene : released())
    for (const char* method : {"bdf2", "midpoint", "verlet", "esdirk4"}) {
      const auto result = guarded(scene, method, 0.1, 0.005);
      EXPECT_EQ(result.outcome, Outcome::success) << scene.name << " " << method << ": " << result.message;
      EXPECT_EQ(result.message, "") << scene.name << " " << method;
    }
}

TEST(EnergyGuard, EndsRunsThatGainMoreThanGravityGives) {
  Scene scene = model::load_scene("hung-corners");
  scene.sheet.material.damping = {3, 3};
  EXPECT_EQ(guarded(scene, "imex-midpoint", 2, 0.01).outcome, Outcome::unstable);
  EXPECT_EQ(guarded(scene, "bdf2", 2, 0.01).outcome, Outcome::success);
  scene.sheet.grid.nu = scene.sheet.grid.nv = 10;
  scene.sheet.material.damping = {};
  EXPECT_EQ(guarded(scene, "imex-midpoint", 0.3, 0.01).outcome, Outcome::unstable);
  EXPECT_EQ(guarded(scene, "bdf2", 0.3, 0.01).outcome, Outcome::success);
  scene.sheet.material.damping = {5, 5};
  EXPECT_EQ(guarded(scene, "bdf2", 1, 1).outcome, Outcome::unstable) << "one step";
}

TEST(EnergyGuard, EvaluatesForcesOnlyWhereTheyGive) {
  const auto count = [](const Scene& scene, bool guards) {
    const Cloth cloth = model::compile(scene);
    bench::EnergyGuardObserver guard;
    std::vector<bench::Observer*> observers;
    if (guards) observers.push_back(&guard);
    bench::run(spec_of(scene, "bdf2", 0.05, 0.01), cloth, observers);
    return std::pair(cloth.ode.work->count("guard_forces"), cloth.ode.work->count("forces") + cloth.ode.work->count("normals"));
  };
  Scene scene = hung_sheet(1e3);
  EXPECT_EQ(count(scene, true).first, 0);
  scene.pins.front().velocity = {0.3, 0, 0};
  EXPECT_EQ(count(scene, true).first, 6) << "moved pins: the start and five steps";
  const Scene curtain = model::load_scene("curtain");
  EXPECT_EQ(count(curtain, true).first, 6) << "projected bending";
  EXPECT_EQ(count(curtain, true).second, count(curtain, false).second) << "they are no work of the method";
}

TEST(EnergyGuard, SaysWhereItCannotJudge) {
  Scene scene = model::load_scene("wind");
  scene.sheet.wind.frequency = 1e3;
  const auto result = guarded(scene, "bdf2", 0.2, 0.05);
  EXPECT_EQ(result.outcome, Outcome::success);
  EXPECT_THAT(result.message, testing::HasSubstr("energy cannot be judged"));
}

/// A run of verlet with sub-steps of a part of their stability limit.
solver::RunResult explicit_run(double fraction, double until) {
  const Scene scene = hung_sheet(1e4);
  const Cloth cloth = model::compile(scene);
  bench::RunSpec spec = spec_of(scene, "verlet", until, 0.01);
  spec.options.verlet_fraction = fraction;
  bench::EnergyGuardObserver guard;
  int seen = 0;
  bench::FunctionObserver look([&](const solver::StepReport& step) {
    if (step.h == 0) return;  // the start
    ++seen;
    EXPECT_LE(solver::kinetic_energy(cloth.ode, step.y.v), guard.guard().limit()) << "steps beyond it are not shown";
  });
  bench::Observer* const observers[] = {&guard, &look};
  const auto result = bench::run(spec, cloth, observers).result;
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
  const Cloth cloth = model::compile(scene);
  EnergyGuard guard(scene, cloth);
  solver::State y = cloth.start;
  EXPECT_FALSE(guard.exceeded({0.01, 0.01, 0, 0, y, {}}));
  y.v(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(guard.exceeded({0.02, 0.01, 0, 0, y, {}}));
}

}  // namespace
}  // namespace drape::verify::energy_guard_test
