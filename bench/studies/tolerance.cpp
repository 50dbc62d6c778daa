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
#include "results/columns.hpp"
#include "results/verdict.hpp"
#include "solver/dense_output.hpp"

namespace drape::bench {
namespace {

using results::Cell;
using results::ColumnOf;
using results::field;
using results::Role;
using results::Standing;
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
  if (ratio > band) return results::verdict(Standing::missed, fmt::format("not within {:g}: over by {:.2g}", band, ratio));
  if (ratio * band >= 1) return results::verdict(Standing::met, fmt::format("within {:g}", band));
  if (run.error < results::resolution * run.uncertainty) return "under: not resolved";
  if (run.largest_steps) return fmt::format("under by {:.2g}: largest steps", 1 / ratio);
  if (!run.note.empty()) return fmt::format("under by {:.2g}: stability", 1 / ratio);
  return results::verdict(Standing::missed, fmt::format("not within {:g}: under by {:.2g}", band, 1 / ratio));
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
      output->observe(step.t, step.y);
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

constexpr ColumnOf<Controlled> controlled_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&Controlled::scene>},
    {"set", "set", "", "what differs from its file", Role::key, field<&Controlled::set>},
    {"method", "method", "", "time integrator", Role::key, field<&Controlled::method>},
    {"tolerance", "tolerance", "1", "of the error over the size of the scene", Role::key, field<&Controlled::tolerance>},
    {"error", "error", "1", "largest RMS distance from the reference at ten times, over the size", Role::error,
     [](const Controlled& run) { return std::isfinite(run.error) ? Cell(run.error) : Cell(); }},
    {"ratio", "error/tolerance", "1", "error over tolerance", Role::note,
     [](const Controlled& run) { return std::isfinite(run.error) ? Cell(run.error / run.tolerance) : Cell(); }},
    {"uncertainty", "±", "1", "of the reference, in the measure of the error", Role::uncertainty,
     field<&Controlled::uncertainty>},
    {"steps", "steps", "1", "accepted steps", Role::counter, field<&Controlled::steps>},
    {"rejected", "rejected", "1", "steps that were not", Role::counter, field<&Controlled::rejected>},
    {"pilot_steps", "pilot steps", "1", "steps of the runs that measured the error before", Role::counter,
     field<&Controlled::pilots>},
    {"forces", "forces", "1", "evaluations, those of pilot runs among them", Role::counter, field<&Controlled::forces>},
    {"verdict", "verdict", "", "whether the error is within ten times of the tolerance, to both sides", Role::verdict,
     field<&Controlled::verdict>},
    {"outcome", "outcome", "", "how the run ended", Role::verdict, field<&Controlled::outcome>},
    {"note", "", "", "what the run says of itself", Role::note, field<&Controlled::note>},
};

results::Table tolerances_on(const Setting& setting, const Methods& methods, ControlledRuns& all, Checkpoint& checkpoint) {
  const model::Scene scene = model::load_scene(setting.scene, setting.overrides);
  checkpoint.show("reference of " + scene.name);
  References references(SweepOptions().agreement, {}, 1e-10);
  const Measurement measure(setting, scene, references(scene, model::compile(scene)));
  checkpoint.advance();
  ControlledRuns runs;
  for (const Method* const chosen : methods) {
    const Method& method = *chosen;
    for (int digits = 2; digits <= setting.digits; ++digits) {
      checkpoint.show(fmt::format("{} on {}, 1e-{}", method.name, scene.name, digits));
      const double tolerance = std::pow(10.0, -digits);
      runs.push_back(checkpoint.once(fmt::format("{} {}", method.name, digits), [&] { return measure(method, tolerance); }));
    }
    checkpoint.advance();
  }
  all.insert(all.end(), runs.begin(), runs.end());
  return results::make_table("tolerance-" + setting.name, "Error over tolerance on " + scene.name, controlled_columns, runs);
}

/// How many runs of a method have become what.
struct MethodSummary {
  std::string method;
  std::int64_t runs = 0, within = 0, over = 0, under = 0, explodes = 0, fails = 0;
  double lowest = INFINITY, highest = 0;  ///< of error to tolerance

  void count(const Controlled& run) {
    const auto says = [&](std::string_view text) { return run.verdict.find(text) != std::string::npos ? 1 : 0; };
    ++runs;
    within += results::standing(run.verdict) == Standing::met ? 1 : 0;
    over += says("over by");
    under += says("under");
    explodes += says("cost explodes");
    fails += says("fails");
    if (!std::isfinite(run.error)) return;
    lowest = std::min(lowest, run.error / run.tolerance);
    highest = std::max(highest, run.error / run.tolerance);
  }

  std::string verdict() const {
    if (fails + explodes == runs) return results::verdict(Standing::open, "no run ends");
    return over + fails == 0 ? results::verdict(Standing::met, "proportional")
                             : results::verdict(Standing::missed, "not proportional");
  }
};

constexpr ColumnOf<MethodSummary> method_summary_columns[] = {
    {"method", "method", "", "time integrator", Role::key, field<&MethodSummary::method>},
    {"runs", "runs", "1", "scenes times tolerances", Role::quantity, field<&MethodSummary::runs>},
    {"within", "within 10", "1", "error between a tenth of the tolerance and ten times it", Role::quantity,
     field<&MethodSummary::within>},
    {"over", "over", "1", "a larger error", Role::quantity, field<&MethodSummary::over>},
    {"under", "under", "1", "a smaller error, whatever the reason", Role::quantity, field<&MethodSummary::under>},
    {"explodes", "cost explodes", "1", "runs that would take too many steps", Role::quantity, field<&MethodSummary::explodes>},
    {"fails", "fails", "1", "runs that end early", Role::quantity, field<&MethodSummary::fails>},
    {"lowest", "lowest ratio", "1", "of error to tolerance", Role::quantity, field<&MethodSummary::lowest>},
    {"highest", "highest", "1", "of error to tolerance", Role::quantity, field<&MethodSummary::highest>},
    {"verdict", "verdict", "", "whether no error is larger than ten tolerances and no run fails", Role::verdict,
     [](const MethodSummary& summary) -> Cell { return summary.verdict(); }},
};

/// Of all scenes and tolerances.
results::Table tolerance_summary(const ControlledRuns& all, const Methods& methods) {
  std::vector<MethodSummary> rows;
  for (const Method* const method : methods) {
    MethodSummary& row = rows.emplace_back(MethodSummary{std::string(method->name)});
    for (const Controlled& run : all)
      if (run.method == method->name) row.count(run);
  }
  return results::make_table("tolerance-summary", "Error over tolerance, all scenes and tolerances", method_summary_columns,
                             rows);
}

}  // namespace

std::vector<TableJob> tolerance(bool quick, const Methods& chosen) {
  const auto all = std::make_shared<ControlledRuns>();
  const Methods methods = all_or(chosen);
  std::vector<TableJob> jobs;
  for (const Setting& setting : settings(quick))
    jobs.push_back({1 + static_cast<int>(methods.size()),
                    [=](Checkpoint& checkpoint) { return tolerances_on(setting, methods, *all, checkpoint); }});
  jobs.push_back({0, [=](Checkpoint&) { return tolerance_summary(*all, methods); }});
  return jobs;
}

}  // namespace drape::bench
