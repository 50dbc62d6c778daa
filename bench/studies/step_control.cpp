#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/samples.hpp"
#include "bench/runs/sweep.hpp"
#include "bench/runs/timing.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/distance.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/base/statistics.hpp"

/// What controls the step of BDF(2) with the thesis' loop: nothing, the number of passes, or the error. "The step is always
/// chosen such that the iteration works effectively" [Etzmuß 2002, 3.4.3]: is it quicker than a constant step as accurate?
namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::Standing;

constexpr double starting_step = 0.01;                ///< [s], where the step is controlled
constexpr double as_quick = 1.1;                      ///< time over that of the best constant step that still counts as equal
constexpr double wrong = 1e-2;                        ///< error over the size above which a motion is another one
constexpr std::int64_t most_evaluations = 1'000'000;  ///< in contact no step has few passes, and steps shrink for ever
constexpr int most_controlled_steps = 20'000;         ///< a run that would take more for its error is not begun

/// A way to choose the step.
struct Policy {
  std::string kind, setting;
  double step = starting_step;  ///< constant, or the first [s]
  solver::StepControl control = {};
  double tolerance = 0;
};

std::vector<Policy> policies(bool quick) {
  std::vector<Policy> all;
  for (int k = 0; k <= (quick ? 4 : 14); ++k) {
    const double h = 0.04 * std::pow(2.0, -0.5 * k);
    all.push_back({"constant", fmt::format("h = {:.3g}", h), h});
  }
  for (const auto& [least, most] : {std::pair(2, 4), {4, 8}, {8, 16}})
    for (const double factor : {1.5, 2.0})
      all.push_back({"passes", fmt::format("{} to {}, {:g}", least, most, factor), starting_step, {least, most, factor}});
  for (const double tolerance : {1e-2, 1e-3, 1e-4})
    all.push_back({"error", fmt::format("{:g}", tolerance), starting_step, {}, tolerance});
  return all;
}

/// A scene and what is set in it.
struct Controlled {
  std::string scene;
  std::vector<model::Override> overrides;

  std::string set() const {
    std::string text;
    for (const model::Override& change : overrides)
      text += fmt::format("{}{}={}", text.empty() ? "" : " ", change.key, change.value);
    return text;
  }
};

std::vector<Controlled> controlled_scenes(bool quick) {
  if (quick) return {{"hung-corners", {{"material.damping", "5"}, {"grid.n", "6"}, {"end.time", "0.2"}}}};
  return {{"hung-corners", {{"material.damping", "50"}}},
          {"hung-corners", {{"material.damping", "5"}}},
          {"hung-corners", {{"material.damping", "0.5"}}},
          {"tablecloth", {}},
          {"wind", {{"end.time", "0.5"}}}};  // its motion loses its memory later
}

/// A run of a policy on a scene.
struct PolicyRun {
  std::string scene, set, kind, setting;
  solver::Outcome outcome = solver::Outcome::success;
  double error = NAN, uncertainty = 0, smallest = 0, largest = 0;
  std::int64_t steps = 0, rejected = 0, pilots = 0, passes = 0, cg_iterations = 0, builds = 0, changes = 0;
  std::size_t most_steps = 0;
  std::optional<double> ms = {};
  std::optional<results::Verdict> verdict = {};

  bool succeeded() const { return outcome == solver::Outcome::success && std::isfinite(error); }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PolicyRun, scene, set, kind, setting, outcome, error, uncertainty, smallest, largest, steps,
                                   rejected, pilots, passes, cg_iterations, builds, changes, most_steps)

RunSpec controlled_spec(const Policy& policy, const model::Scene& scene) {
  RunSpec spec{scene, "", &solver::method("bdf2"), policy.step, solver::thesis_options()};
  spec.options.max_updates = 20'000;  // with little damping the loop is slow
  spec.options.control = policy.control;
  if (policy.tolerance > 0)
    spec.options.error_control = {policy.tolerance, model::size(scene), scene.end, !model::has_contacts(scene),
                                  most_controlled_steps};
  return spec;
}

/// Steps and their changes; the last step is clipped.
void count_steps(const results::RunRecord& run, PolicyRun& result) {
  result.steps = std::ssize(run.steps);
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k) {
    const double h = run.steps[k].h;
    result.smallest = k == 0 ? h : std::min(result.smallest, h);
    result.largest = std::max(result.largest, h);
    result.changes += k > 0 && std::abs(h / run.steps[k - 1].h - 1) > 1e-9;
  }
  for (const auto& step : run.steps) result.passes += step.updates, result.cg_iterations += step.cg_iterations;
}

PolicyRun run_policy(const Controlled& setting, const Policy& policy, const RunSpec& spec,
                     const reference::Reference& reference) {
  Samples samples(reference.trajectory.times);
  Observer* const observers[] = {&samples};
  const results::RunRecord run = record(spec, observers, {.evaluations = most_evaluations});
  PolicyRun result{setting.scene, setting.set(), policy.kind, policy.setting, run.outcome};
  const double size = model::size(spec.scene);
  result.uncertainty = std::ranges::max(reference.error) / size;
  result.rejected = results::work_count(run, "rejected_steps");
  result.pilots = results::work_count(run, "pilot_steps");
  result.builds = results::work_count(run, "matrix_builds");
  result.most_steps = steps_to_time(run);
  count_steps(run, result);
  if (!run.succeeded()) return result;
  const auto truth = reference::positions_of(reference.trajectory.states);
  result.error = reference::largest_rms_distance(reference::positions_of(std::move(samples).states()), truth) / size;
  return result;
}

/// The quickest constant step whose error is not larger; null if there is none.
const PolicyRun* best_constant(const std::vector<PolicyRun>& runs, double error) {
  const PolicyRun* best = nullptr;
  for (const PolicyRun& run : runs)
    if (run.kind == "constant" && run.succeeded() && run.error <= error && (best == nullptr || *run.ms < *best->ms))
      best = &run;
  return best;
}

results::Verdict verdict_on(const PolicyRun& run, const std::vector<PolicyRun>& all) {
  if (!run.succeeded()) return {Standing::missed, std::string(to_string(run.outcome))};
  if (run.error > wrong) return {Standing::missed, fmt::format("unnoticed error {:.2g}", run.error)};
  const PolicyRun* best = best_constant(all, run.error);
  if (best == nullptr) return {Standing::open, "no constant step is as accurate"};
  const double ratio = *run.ms / *best->ms;
  return {ratio <= as_quick ? Standing::met : Standing::missed,
          fmt::format("{:.2g} of the time with {}", ratio, best->setting)};
}

constexpr ColumnOf<PolicyRun> policy_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&PolicyRun::scene>},
    {"set", "set", "", "what differs from its file", Role::key, field<&PolicyRun::set>},
    {"policy", "step by", "", "constant; or controlled by the passes of the loop, or by an estimate of the error", Role::key,
     field<&PolicyRun::kind>},
    {"setting", "setting", "", "the step [s]; least and most passes and the factor of a change; the tolerance", Role::key,
     field<&PolicyRun::setting>},
    {"error", "error", "1", "largest RMS distance from the reference at ten times, over the size", Role::error,
     [](const PolicyRun& run) { return run.succeeded() ? Datum(run.error) : Datum(); }},
    {"uncertainty", "±", "1", "of the reference, in the measure of the error", Role::uncertainty,
     field<&PolicyRun::uncertainty>},
    {"steps", "steps", "1", "accepted steps", Role::counter, field<&PolicyRun::steps>},
    {"rejected", "rejected", "1", "steps that were not", Role::counter, field<&PolicyRun::rejected>},
    {"pilot_steps", "pilots", "1", "steps of the runs that measured the error before", Role::counter,
     field<&PolicyRun::pilots>},
    {"passes", "passes", "1", "of the loop, in accepted steps", Role::counter, field<&PolicyRun::passes>},
    {"cg_iterations", "CG", "1", "iterations of conjugate gradients, in accepted steps", Role::counter,
     field<&PolicyRun::cg_iterations>},
    {"matrix_builds", "builds", "1", "assemblies of the matrix, each with a factorisation", Role::counter,
     field<&PolicyRun::builds>},
    {"changes", "changes", "1", "how often the step was changed", Role::counter, field<&PolicyRun::changes>},
    {"smallest", "least h", "s", "smallest step, except the last", Role::quantity, field<&PolicyRun::smallest>},
    {"largest", "most h", "s", "largest step", Role::quantity, field<&PolicyRun::largest>},
    {"ms", "time", "ms", "wall time of the solver, median of interleaved runs", Role::time, field<&PolicyRun::ms>},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&PolicyRun::outcome>},
    {"verdict", "verdict", "", "whether it is as quick as the best constant step that is as accurate", Role::verdict,
     field<&PolicyRun::verdict>},
};

/// Times of the runs that reached their end, interleaved.
void time_policies(const Group& group, std::vector<PolicyRun>& runs, bool quick, Checkpoint& checkpoint) {
  Group timed;
  std::vector<std::size_t> most_steps;
  std::vector<PolicyRun*> rows;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (runs[k].succeeded()) {
      timed.push_back(group[k]);
      most_steps.push_back(runs[k].most_steps);
      rows.push_back(&runs[k]);
    }
  const auto times = checkpoint.timed("times", [&] { return time_group(timed, most_steps, quick ? 1 : 3, [] {}); });
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k]->ms = base::quantile(times[k], 0.5);
}

std::vector<PolicyRun> run_policies(const Controlled& setting, bool quick, Checkpoint& checkpoint) {
  checkpoint.begin(setting.scene + " " + setting.set());
  const model::Scene scene = model::load_scene(setting.scene, setting.overrides);
  checkpoint.show("reference of " + scene.name);
  References references(SweepOptions().agreement);
  const reference::Reference truth = references(scene, model::compile(scene));
  Group group;
  std::vector<PolicyRun> runs;
  checkpoint.each(policies(quick), [&](const Policy& policy) {
    const std::string id = policy.kind + " " + policy.setting;
    checkpoint.show(fmt::format("{} {}, {}", scene.name, setting.set(), id));
    group.push_back(controlled_spec(policy, scene));
    runs.push_back(checkpoint.once(id, [&] { return run_policy(setting, policy, group.back(), truth); }));
    checkpoint.advance();
  });
  time_policies(group, runs, quick, checkpoint);
  for (PolicyRun& run : runs)
    if (run.kind != "constant") run.verdict = verdict_on(run, runs);
  return runs;
}

results::Table policy_table(const std::vector<PolicyRun>& rows) {
  return results::make_table("step-control",
                             "BDF(2) with the thesis' loop: constant steps, steps by passes, steps by the error",
                             policy_columns, rows);
}

}  // namespace

std::vector<Job> step_control(const Question& question) {
  const bool quick = question.quick;
  const std::vector<Controlled> list = controlled_scenes(quick);
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<PolicyRun> rows;
    checkpoint.each(list, [&](const Controlled& setting) {
      std::ranges::move(run_policies(setting, quick, checkpoint), std::back_inserter(rows));
    });
    return rows;
  };
  return {job("step-control", static_cast<int>(list.size() * policies(quick).size()), compute, policy_table)};
}

}  // namespace drape::bench
