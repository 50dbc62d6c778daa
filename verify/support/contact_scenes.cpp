#include "verify/support/contact_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace drape::verify::contact_scenes {
namespace {

Trial compiled(const model::Scene& scene) { return {scene, model::compile(scene)}; }

Trial trial(const std::string& toml, std::span<const model::Override> changes) {
  return compiled(model::parse_scene(toml, "test", changes));
}

}  // namespace

std::vector<std::string> methods() {
  std::vector<std::string> names;
  for (const solver::Method& method : solver::methods())
    if (method.meets_obstacles) names.emplace_back(method.name);
  return names;
}

Trial particles(const std::string& more, std::span<const model::Override> changes) {
  return trial("name = 'particles'\ngrid = { n = 2, size = 0.1 }\nforces = { gravity = [0, 0, -9.81] }\n" + more, changes);
}

Trial sheet(const std::string& more, std::span<const model::Override> changes) {
  return trial(
      "name = 'sheet'\ngrid = { n = 7, size = 0.3 }\n"
      "material = { tension = 1e3, damping = 5, shear = 50, bend = 1e-3, bend_projected = false, density = 0.5 }\n"
      "forces = { gravity = [0, 0, -9.81] }\n" +
          more,
      changes);
}

Trial builtin(const std::string& name, std::span<const model::Override> changes) {
  return compiled(model::load_scene(name, changes));
}

std::vector<Moment> run(const Trial& trial, const std::string& method, double h, const solver::Options& options) {
  const solver::SplitOde& ode = trial.cloth.ode;
  const auto moment = [&](double t, const solver::State& y, const solver::ContactReport& contacts) {
    return Moment{t, y, solver::kinetic_energy(ode, y.v) + ode.potential_energy(t, y.x), contacts};
  };
  std::vector<Moment> moments{moment(0, trial.cloth.start, {})};
  solver::Integrator integrator(ode, solver::method(method), options, trial.cloth.start);
  const solver::RunResult result = integrate(integrator, trial.scene.end, h, [&](const solver::StepReport& step) {
    moments.push_back(moment(step.t, step.y, step.contacts));
  });
  EXPECT_EQ(result.outcome, solver::Outcome::success) << method << ": " << result.message;
  return moments;
}

double energy_rise(const std::vector<Moment>& moments) {
  double least = moments.front().energy, rise = 0;
  for (const Moment& moment : moments) {
    rise = std::max(rise, moment.energy - least);
    least = std::min(least, moment.energy);
  }
  return rise;
}

double clearance(const Trial& trial, const std::vector<Moment>& moments) {
  double least = std::numeric_limits<double>::infinity();
  for (const Moment& moment : moments)
    least = std::min(least, trial.cloth.contacts->distances(moment.t, moment.y.x).minCoeff());
  return least;
}

}  // namespace drape::verify::contact_scenes
