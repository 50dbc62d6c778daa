#include "bench/studies/claims/sheet_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/runs/motion_error.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/samples.hpp"
#include "reference/distance.hpp"

namespace drape::bench {

model::Scene with(const std::string& scene, std::vector<model::Override> overrides) {
  return model::load_scene(scene, overrides);
}

model::Scene hung(double damping, double end) {
  return with("hung-corners", {{"material.damping", fmt::format("{}", damping)}, {"end.time", fmt::format("{}", end)}});
}

results::RunRecord run_by(const model::Scene& scene, const std::string& method, double step) {
  RunSpec spec{scene, "", nullptr, step, {}};
  choose_method(spec, method);
  return record(spec);
}

std::vector<solver::State> states_by(const model::Scene& scene, const std::string& method, double step,
                                     const std::vector<double>& times) {
  RunSpec spec{scene, "", nullptr, step, {}};
  choose_method(spec, method);
  Samples samples(times);
  Observer* const observers[] = {&samples};
  record(spec, observers);
  return std::move(samples).states();
}

FineMotion fine_motion(const model::Scene& scene) {
  constexpr double fine = 1e-3;
  const model::Cloth cloth = model::compile(scene);
  FineMotion found;
  const int count = static_cast<int>(std::lround(scene.end / (2 * fine)));
  for (int k = 1; k <= count; ++k) found.motion.times.push_back(2 * fine * k);
  found.motion.states = states_by(scene, "midpoint", fine, found.motion.times);
  const auto coarse = states_by(scene, "midpoint", 2 * fine, {scene.end});
  found.uncertainty = reference::rms_distance(found.motion.states.back().x, coarse.back().x) / 3;  // of order 2
  found.motion.times.insert(found.motion.times.begin(), 0);
  found.motion.states.insert(found.motion.states.begin(), cloth.start);
  return found;
}

double distance_at_end(const model::Scene& scene, const results::RunRecord& run, const solver::Vectors& x) {
  return run.succeeded() ? reference::rms_distance(run.final_state.x, x) / model::size(scene) : NAN;
}

double largest_accurate_step(const model::Scene& scene, const std::string& method, const solver::Vectors& x, double part) {
  constexpr int most_steps = 10'000;
  double accurate = NAN;  // the step before, if it is
  for (int n = 10; n <= most_steps; n *= 2) {
    const double step = scene.end / n;
    const bool ends_near = distance_at_end(scene, run_by(scene, method, step), x) <= part;
    if (ends_near && !std::isnan(accurate)) return accurate;
    accurate = ends_near ? step : NAN;
  }
  return NAN;
}

double work_of(const results::RunRecord& run, const char* kind) {
  return run.succeeded() ? static_cast<double>(results::work_count(run, kind)) : NAN;
}

double energy_gain(const model::Scene& scene, const std::string& method, double step) {
  const model::Cloth cloth = model::compile(scene);
  const double start = total_energy(cloth, 0, cloth.start);
  const results::RunRecord run = run_by(scene, method, step);
  double gain = 0;
  for (const results::StepRecord& one : run.steps) gain = std::max(gain, one.kinetic_energy + one.potential_energy - start);
  return gain;
}

}  // namespace drape::bench
