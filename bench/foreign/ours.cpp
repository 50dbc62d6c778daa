#include "bench/foreign/ours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "bench/cell.hpp"

namespace drape::bench {
namespace {

constexpr double well = 4;  ///< so many times below an error or beyond a cost

Problem problem_of(const TrueMotion& truth, const std::vector<FrameScore>& frames) {
  Problem problem{truth.scene.name, truth.scene, model::size(truth.scene)};
  problem.scene.end = frames.back().t;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    problem.times.push_back(frames[k].t);
    problem.truth.push_back(state_at(truth.motion, frames[k].t).x);
    problem.uncertainty = std::max(problem.uncertainty, frames[k].uncertainty / problem.length);
  }
  problem.growth = truth.growth;
  return problem;
}

/// The trial with the least error among those that take no longer [ms].
std::optional<std::size_t> least_wrong(const std::vector<results::Measured>& trials, double longest) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < trials.size(); ++k)
    if (!trials[k].times.empty() && results::quartiles(trials[k].times).median <= longest &&
        (!best || trials[k].error < trials[*best].error))
      best = k;
  return best;
}

std::vector<results::Measured> measured(const std::vector<Trial>& trials) {
  std::vector<results::Measured> all;
  for (const Trial& trial : trials) all.push_back(trial.measured);
  return all;
}

}  // namespace

double largest_rms(const std::vector<FrameScore>& frames) { return std::ranges::max(frames, {}, &FrameScore::rms).rms; }

Ours try_ours(const TrueMotion& truth, const std::vector<FrameScore>& frames, const std::vector<std::string>& methods,
              std::optional<double> cost, int repetitions, Units& units) {
  Problem problem = problem_of(truth, frames);
  const double error = largest_rms(frames) / problem.length;
  Effort effort{.repetitions = repetitions};
  if (cost)
    effort.cap = std::max(effort.cap, well * *cost);
  else
    problem.enough = error / well;
  Ours ours;
  for (const std::string& method : methods) ours.families.push_back(ladder(problem.scene, method));
  ours.trials = try_all(problem, ours.families, effort, units);
  problem.asked = {error};
  if (cost)
    if (const auto best = least_wrong(measured(ours.trials), 1e3 * *cost))
      problem.asked.push_back(ours.trials[*best].measured.error);
  units.show("timing " + problem.name);
  time_fronts(problem, ours.trials, effort, units);
  Contender all{"ours", std::vector<std::size_t>(ours.trials.size())};
  std::iota(all.members.begin(), all.members.end(), 0);
  const std::vector<results::Measured> repeated = timed(all, ours.trials);
  ours.as_right = results::quickest(repeated, error);
  if (cost) ours.at_cost = least_wrong(repeated, 1e3 * *cost);
  return ours;
}

void check_methods(const std::vector<std::string>& methods, const model::Scene& scene) {
  for (const std::string& name : methods) {
    Cell cell{scene, "", nullptr, scene.end, {}};
    choose_method(cell, name);
    if (!scene.obstacles.empty() && !cell.method->meets_obstacles)
      throw std::invalid_argument(fmt::format("method '{}': expected one that meets obstacles, as the scene has some", name));
  }
}

}  // namespace drape::bench
