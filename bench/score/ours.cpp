#include "bench/score/ours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/runs/run.hpp"
#include "model/cloth.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

constexpr double well = 4;  ///< factor below an error or beyond a cost

Problem problem_of(const TrueMotion& truth, const std::vector<FrameScore>& frames) {
  Problem problem{truth.scene.name, truth.scene, model::size(truth.scene)};
  problem.scene.end = frames.back().t;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    problem.times.push_back(frames[k].t);
    problem.truth.push_back(state_at(truth.motion, frames[k].t).x);
    problem.uncertainty = base::larger(problem.uncertainty, frames[k].uncertainty / problem.length);
  }
  problem.growth = truth.growth;
  return problem;
}

double time_of(const ComparedRun& run) {
  return run.measured.times.empty() ? INFINITY : results::quartiles(run.measured.times).median;
}

/// `longest` [ms]: NaN if it is not known.
void update(Answers& answers, const ComparedRun& run, double error, double longest) {
  if (run.measured.error <= error && (answers.as_right == nullptr || time_of(run) < time_of(*answers.as_right)))
    answers.as_right = &run;
  if (time_of(run) <= longest && (answers.at_cost == nullptr || run.measured.error < answers.at_cost->measured.error))
    answers.at_cost = &run;
}

std::vector<Answers> answers_of(const Ours& ours, double error, double longest) {
  std::vector<Answers> all;
  for (const Configuration& configuration : ours.configurations) {
    Answers& answers = all.emplace_back();
    for (const ComparedRun& run : ours.runs)
      if (run.configuration == &configuration) update(answers, run, error, longest);
  }
  return all;
}

}  // namespace

double known_error(const std::vector<FrameScore>& frames) {
  return std::max(std::ranges::max(frames, {}, &FrameScore::rms).rms,
                  std::ranges::max(frames, {}, &FrameScore::uncertainty).uncertainty);
}

Ours try_ours(const TrueMotion& truth, const std::vector<FrameScore>& frames, const std::vector<std::string>& methods,
              std::optional<double> cost, int repetitions, Checkpoint& checkpoint) {
  Problem problem = problem_of(truth, frames);
  const double error = known_error(frames) / problem.length;
  Effort effort{.repetitions = repetitions, .time_of = TimeOf::wall};  // as the other simulator's
  if (cost)
    effort.limits.seconds = std::max(effort.limits.seconds, well * *cost);
  else
    problem.enough = error / well;
  Ours ours;
  for (const std::string& method : methods) ours.configurations.push_back(ladder(problem.scene, method));
  ours.runs = run_all(problem, ours.configurations, effort, checkpoint);
  const double longest = cost ? 1e3 * *cost : NAN;
  problem.asked = {error};
  for (const Answers& answers : answers_of(ours, error, longest))  // by a first run each, to know what to time
    if (answers.at_cost != nullptr) problem.asked.push_back(answers.at_cost->measured.error);
  checkpoint.show("timing " + problem.name);
  time_fronts(problem, ours.runs, effort, {}, checkpoint);
  ours.answers = answers_of(ours, error, longest);
  for (const ComparedRun& run : ours.runs) update(ours.best, run, error, longest);
  return ours;
}

void check_methods(const std::vector<std::string>& methods, const model::Scene& scene) {
  for (const std::string& name : methods) {
    RunSpec cell{scene, "", nullptr, scene.end, {}};
    choose_method(cell, name);
    if (!scene.obstacles.empty() && !cell.method->meets_obstacles)
      throw std::invalid_argument(fmt::format("method '{}': expected one that meets obstacles, as the scene has some", name));
    if (cell.method->needs_energies && !model::forces_without_energy(scene).empty())
      throw std::invalid_argument(
          fmt::format("method '{}': expected elastic forces with mean forces, as not all of the scene", name));
  }
}

}  // namespace drape::bench
