#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/sweep.hpp"
#include "bench/studies/studies.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/distance.hpp"
#include "solver/dense_output.hpp"

namespace drape::bench {
namespace {

using solver::Method;

/// Error over tolerance that a user may rely on, to both sides.
constexpr double band = 10;

/// A scene, what is set in it, and how far the study goes there.
struct Setting {
  std::string name;
  std::string scene;
  std::vector<model::Override> overrides;
  int digits = 7;           ///< the tolerances are 1e-2 to 1e-digits
  int most_steps = 20'000;  ///< a run that would take more is not begun
};

/// All built-in scenes without obstacles. The large one has fewer particles and motions that lose their memory end earlier, so
/// that references are certain.
std::vector<Setting> settings(bool quick) {
  if (quick)
    return {{"hung-edge", "hung-edge", {{"grid.n", "6"}, {"material.damping", "0.5"}, {"end.time", "0.2"}}, 3, 2000},
            {"chain", "chain", {{"end.time", "0.3"}}, 3, 2000}};
  std::vector<Setting> all;
  for (const char* scene : {"hung-edge", "hung-corners"})
    all.push_back({fmt::format("{}-hardly-damped", scene), scene, {{"material.damping", "0.5"}}});
  for (const model::BuiltinScene& scene : model::builtin_scenes()) {
    if (!model::parse_scene(scene.toml, scene.name).obstacles.empty()) continue;
    Setting& setting = all.emplace_back(Setting{std::string(scene.name), std::string(scene.name), {}});
    if (scene.name == "peer-edge") setting.overrides = {{"grid.n", "20"}};
    if (scene.name == "wind" || scene.name == "curtain") setting.overrides = {{"end.time", "0.5"}};
  }
  return all;
}

/// What becomes of one method with one tolerance.
struct Controlled {
  std::string scene, set, method;
  double tolerance = 0, error = NAN, uncertainty = 0;
  std::int64_t steps = 0, rejected = 0, pilots = 0, forces = 0;
  bool largest_steps = false;  ///< whether some steps are as long as allowed
  std::string outcome, note, verdict;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Controlled, scene, set, method, tolerance, error, uncertainty, steps, rejected, pilots,
                                   forces, largest_steps, outcome, note, verdict)

/// Of all scenes.
using ControlledRuns = std::vector<Controlled>;

std::string judge(const Controlled& run) {
  if (run.outcome != to_string(solver::Outcome::success)) return run.steps == 0 ? "cost explodes" : "fails";
  const double ratio = run.error / run.tolerance;
  if (ratio > band) return fmt::format("NOT within {:g}: over by {:.2g}", band, ratio);
  if (ratio * band >= 1) return fmt::format("within {:g}", band);
  if (run.error < results::resolution * run.uncertainty) return "under: not resolved";
  if (run.largest_steps) return fmt::format("under by {:.2g}: largest steps", 1 / ratio);
  if (!run.note.empty()) return fmt::format("under by {:.2g}: stability", 1 / ratio);
  return fmt::format("NOT within {:g}: under by {:.2g}", band, 1 / ratio);
}

/// Runs of a scene, measured at all tenths of its time.
class Measurement {
 public:
  Measurement(const Setting& setting, const model::Scene& scene, reference::Reference reference)
      : setting_(setting), scene_(scene), reference_(std::move(reference)) {}

  Controlled operator()(const Method& method, double tolerance) const {
    RunSpec cell{scene_, "", &method, scene_.end / 5, {}};
    cell.options.error_control = {tolerance, model::size(scene_), scene_.end, true, setting_.most_steps};
    std::optional<solver::SmoothOutput> output;
    FunctionObserver sample([&](const solver::StepReport& step) {
      if (!output) return (void)output.emplace(reference_.trajectory.times, step.t, step.y);
      output->see(step.t, step.y);
    });
    Observer* const observers[] = {&sample};
    const results::RunRecord run = record(cell, observers);
    Controlled result;
    result.scene = scene_.name;
    result.set = set();
    result.method = method.name;
    result.tolerance = tolerance;
    result.uncertainty = std::ranges::max(reference_.error) / model::size(scene_);
    result.outcome = to_string(run.outcome);
    result.note = run.message;
    result.steps = std::ssize(run.steps);
    result.rejected = results::work_count(run, "rejected_steps");
    result.pilots = results::work_count(run, "pilot_steps");
    result.forces = results::work_count(run, "forces") + results::work_count(run, "explicit_forces");
    result.largest_steps = std::ranges::any_of(run.steps, [&](const auto& step) { return step.h > 0.99 * cell.step; });
    if (run.outcome == solver::Outcome::success) result.error = error(output->positions);
    result.verdict = judge(result);
    return result;
  }

 private:
  std::string set() const {
    std::string text;
    for (const model::Override& change : setting_.overrides)
      text += fmt::format("{}{}={}", text.empty() ? "" : " ", change.key, change.value);
    return text;
  }

  double error(const std::vector<solver::Vectors>& positions) const {
    const auto truth = reference::positions_of(reference_.trajectory.states);
    return reference::largest_rms_distance(positions, truth) / model::size(scene_);
  }

  const Setting& setting_;
  const model::Scene& scene_;
  const reference::Reference reference_;
};

void add_row(results::TableBuilder& table, const Controlled& run) {
  table.row();
  table.text("scene", "scene", "its name", run.scene);
  table.text("set", "set", "what differs from its file", run.set);
  table.text("method", "method", "time integrator", run.method);
  table.number("tolerance", "tolerance", "1", "of the error over the size of the scene", run.tolerance);
  if (std::isfinite(run.error)) {
    table.number("error", "error", "1", "largest RMS distance from the reference at ten times, over the size", run.error);
    table.number("ratio", "error/tolerance", "1", "error over tolerance", run.error / run.tolerance);
  }
  table.number("uncertainty", "±", "1", "of the reference, in the measure of the error", run.uncertainty);
  table.count("steps", "steps", "accepted steps", run.steps);
  table.count("rejected", "rejected", "steps that were not", run.rejected);
  table.count("pilot_steps", "pilot steps", "steps of the runs that measured the error before", run.pilots);
  table.count("forces", "forces", "evaluations, those of pilot runs among them", run.forces);
  table.text("outcome", "outcome", "how the run ended", run.outcome);
  table.text("note", "", "what the run says of itself", run.note);
  table.text("verdict", "verdict", "whether the error is within ten times of the tolerance, to both sides", run.verdict);
}

results::Table tolerances_on(const Setting& setting, const Methods& methods, ControlledRuns& all, Checkpoint& checkpoint) {
  const model::Scene scene = model::load_scene(setting.scene, setting.overrides);
  results::TableBuilder table("tolerance-" + setting.name, "Error over tolerance on " + scene.name);
  checkpoint.show("reference of " + scene.name);
  References references(SweepOptions().agreement, {}, 1e-10);
  const Measurement measure(setting, scene, references(scene, model::compile(scene)));
  checkpoint.advance();
  for (const Method* const chosen : methods) {
    const Method& method = *chosen;
    for (int digits = 2; digits <= setting.digits; ++digits) {
      checkpoint.show(fmt::format("{} on {}, 1e-{}", method.name, scene.name, digits));
      const double tolerance = std::pow(10.0, -digits);
      all.push_back(checkpoint.once(fmt::format("{} {}", method.name, digits), [&] { return measure(method, tolerance); }));
      add_row(table, all.back());
    }
    checkpoint.advance();
  }
  return table.finish();
}

/// How many cells of a method have become what.
results::Table summary(const ControlledRuns& all, const Methods& methods) {
  results::TableBuilder table("tolerance-summary", "Error over tolerance, all scenes and tolerances");
  for (const Method* const chosen : methods) {
    const Method& method = *chosen;
    ControlledRuns runs;
    std::ranges::copy_if(all, std::back_inserter(runs), [&](const Controlled& run) { return run.method == method.name; });
    const auto count = [&](std::string_view verdict) {
      return std::ranges::count_if(runs, [&](const Controlled& run) { return run.verdict.find(verdict) != std::string::npos; });
    };
    double lowest = INFINITY, highest = 0;
    for (const Controlled& run : runs) {
      if (!std::isfinite(run.error)) continue;
      lowest = std::min(lowest, run.error / run.tolerance);
      highest = std::max(highest, run.error / run.tolerance);
    }
    table.row();
    table.text("method", "method", "time integrator", std::string(method.name));
    table.count("runs", "runs", "scenes times tolerances", std::ssize(runs));
    table.count("within", "within 10", "error between a tenth of the tolerance and ten times it",
                count("within 10") - count("NOT"));
    table.count("over", "over", "a larger error", count("over by"));
    table.count("under", "under", "a smaller error, whatever the reason", count("under"));
    table.count("explodes", "cost explodes", "runs that would take too many steps", count("cost explodes"));
    table.count("fails", "fails", "runs that end early", count("fails"));
    table.number("lowest", "lowest ratio", "1", "of error to tolerance", lowest);
    table.number("highest", "highest", "1", "of error to tolerance", highest);
    table.text("verdict", "verdict", "whether no error is larger than ten tolerances and no run fails",
               count("over by") + count("fails") == 0 ? "proportional" : "NOT proportional");
  }
  return table.finish();
}

}  // namespace

std::vector<TableJob> tolerance(bool quick, const Methods& chosen) {
  const auto all = std::make_shared<ControlledRuns>();
  const Methods methods = all_or(chosen);
  std::vector<TableJob> jobs;
  for (const Setting& setting : settings(quick))
    jobs.push_back({1 + static_cast<int>(methods.size()),
                    [=](Checkpoint& checkpoint) { return tolerances_on(setting, methods, *all, checkpoint); }});
  jobs.push_back({0, [=](Checkpoint&) { return summary(*all, methods); }});
  return jobs;
}

}  // namespace drape::bench
