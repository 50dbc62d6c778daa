#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

using results::ColumnOf;
using results::Datum;
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

/// The large scene has fewer particles, and motions that lose their memory end earlier, so that references are certain.
struct Shortened {
  const char *scene, *key, *value;
};
constexpr Shortened shortened[] = {
    {"peer-edge", "grid.n", "20"}, {"wind", "end.time", "0.5"}, {"curtain", "end.time", "0.5"}, {"skirt", "end.time", "0.3"}};

/// All built-in scenes without obstacles.
std::vector<Setting> settings(bool quick) {
  if (quick)
    return {{"hung-edge", "hung-edge", {{"grid.n", "6"}, {"material.damping", "0.5"}, {"end.time", "0.2"}}, 3, 2000},
            {"chain", "chain", {{"end.time", "0.3"}}, 3, 2000}};
  std::vector<Setting> all;
  for (const char* scene : {"hung-edge", "hung-corners"})
    all.push_back({fmt::format("{}-hardly-damped", scene), scene, {{"material.damping", "0.5"}}});
  for (const model::BuiltinScene& scene : model::builtin_scenes()) {
    if (model::has_contacts(model::parse_scene(scene.toml, scene.name))) continue;
    Setting& setting = all.emplace_back(Setting{std::string(scene.name), std::string(scene.name), {}});
    for (const auto& [name, key, value] : shortened)
      if (scene.name == name) setting.overrides.push_back({key, value});
  }
  return all;
}

/// How an error and its tolerance go together.
enum class Proportion {
  within,    ///< of the band
  over,      ///< the error is larger,
  under,     ///< or smaller
  explodes,  ///< the run would take too many steps
  fails,     ///< it ended early
};

/// A run of one method with one tolerance.
struct ControlledRun {
  std::string scene, set, method;
  double tolerance = 0, error = NAN, uncertainty = 0;
  std::int64_t steps = 0, rejected = 0, pilots = 0, forces = 0;
  bool largest_steps = false;  ///< whether some steps are as long as allowed
  solver::Outcome outcome = solver::Outcome::success;
  std::string note;
  Proportion proportion = Proportion::within;

  double ratio() const { return error / tolerance; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ControlledRun, scene, set, method, tolerance, error, uncertainty, steps, rejected, pilots,
                                   forces, largest_steps, outcome, note, proportion)

/// All methods and tolerances on a scene.
struct ControlledRuns {
  std::string setting, scene;
  std::vector<ControlledRun> runs;
};

Proportion proportion(const ControlledRun& run) {
  if (run.outcome != solver::Outcome::success) return run.steps == 0 ? Proportion::explodes : Proportion::fails;
  if (run.ratio() > band) return Proportion::over;
  return run.ratio() * band >= 1 ? Proportion::within : Proportion::under;
}

results::Verdict verdict_under(const ControlledRun& run) {
  const double factor = 1 / run.ratio();
  if (run.error < results::resolution * run.uncertainty) return {Standing::open, "under: not resolved"};
  if (run.largest_steps) return {Standing::open, fmt::format("under by {:.2g}: largest steps", factor)};
  if (!run.note.empty()) return {Standing::open, fmt::format("under by {:.2g}: stability", factor)};
  return {Standing::missed, fmt::format("not within {:g}: under by {:.2g}", band, factor)};
}

results::Verdict verdict_on(const ControlledRun& run) {
  switch (run.proportion) {
    case Proportion::within: return {Standing::met, fmt::format("within {:g}", band)};
    case Proportion::over: return {Standing::missed, fmt::format("not within {:g}: over by {:.2g}", band, run.ratio())};
    case Proportion::under: return verdict_under(run);
    case Proportion::explodes: return {Standing::open, "cost explodes"};
    case Proportion::fails: return {Standing::open, "fails"};
  }
  return {};
}

/// Runs of a scene, measured at all tenths of its time.
class Measurement {
 public:
  Measurement(const Setting& setting, const model::Scene& scene, reference::Reference reference)
      : setting_(setting), scene_(scene), reference_(std::move(reference)) {}

  ControlledRun operator()(const Method& method, double tolerance) const {
    RunSpec spec{scene_, "", &method, scene_.end / 5, {}};
    spec.options.error_control = {tolerance, model::size(scene_), scene_.end, true, setting_.most_steps};
    std::optional<solver::SmoothOutput> output;
    FunctionObserver sample([&](const solver::StepReport& step) {
      if (!output) return (void)output.emplace(reference_.trajectory.times, step.t, step.y);
      output->observe(step.t, step.y);
    });
    Observer* const observers[] = {&sample};
    const results::RunRecord run = record(spec, observers);
    ControlledRun result;
    result.scene = scene_.name;
    result.set = set();
    result.method = method.name;
    result.tolerance = tolerance;
    result.uncertainty = std::ranges::max(reference_.error) / model::size(scene_);
    result.outcome = run.outcome;
    result.note = run.message;
    result.steps = std::ssize(run.steps);
    result.rejected = results::work_count(run, "rejected_steps");
    result.pilots = results::work_count(run, "pilot_steps");
    result.forces = results::work_count(run, "forces") + results::work_count(run, "explicit_forces");
    result.largest_steps = std::ranges::any_of(run.steps, [&](const auto& step) { return step.h > 0.99 * spec.step; });
    if (run.succeeded()) result.error = error(output->positions);
    result.proportion = proportion(result);
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

constexpr ColumnOf<ControlledRun> controlled_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&ControlledRun::scene>},
    {"set", "set", "", "what differs from its file", Role::key, field<&ControlledRun::set>},
    {"method", "method", "", "time integrator", Role::key, field<&ControlledRun::method>},
    {"tolerance", "tolerance", "1", "of the error over the size of the scene", Role::key, field<&ControlledRun::tolerance>},
    {"error", "error", "1", "largest RMS distance from the reference at ten times, over the size", Role::error,
     [](const ControlledRun& run) { return std::isfinite(run.error) ? Datum(run.error) : Datum(); }},
    {"ratio", "error/tolerance", "1", "error over tolerance", Role::note,
     [](const ControlledRun& run) { return std::isfinite(run.error) ? Datum(run.ratio()) : Datum(); }},
    {"uncertainty", "±", "1", "of the reference, in the measure of the error", Role::uncertainty,
     field<&ControlledRun::uncertainty>},
    {"steps", "steps", "1", "accepted steps", Role::counter, field<&ControlledRun::steps>},
    {"rejected", "rejected", "1", "steps that were not", Role::counter, field<&ControlledRun::rejected>},
    {"pilot_steps", "pilot steps", "1", "steps of the runs that measured the error before", Role::counter,
     field<&ControlledRun::pilots>},
    {"forces", "forces", "1", "evaluations, those of pilot runs among them", Role::counter, field<&ControlledRun::forces>},
    {"verdict", "verdict", "", "whether the error is within ten times of the tolerance, to both sides", Role::verdict,
     [](const ControlledRun& run) { return results::to_datum(verdict_on(run)); }},
    {"outcome", "outcome", "", "how the run ended", Role::outcome, field<&ControlledRun::outcome>},
    {"note", "", "", "what the run says of itself", Role::note, field<&ControlledRun::note>},
};

ControlledRuns tolerances_on(const Setting& setting, const Methods& methods, Checkpoint& checkpoint) {
  checkpoint.begin(setting.name);
  const model::Scene scene = model::load_scene(setting.scene, setting.overrides);
  checkpoint.show("reference of " + scene.name);
  References references(SweepOptions().agreement, {}, 1e-10);
  const Measurement measure(setting, scene, references(scene, model::compile(scene)));
  checkpoint.advance();
  ControlledRuns all{setting.name, scene.name, {}};
  checkpoint.each(methods, [&](const Method* chosen) {
    const Method& method = *chosen;
    for (int digits = 2; digits <= setting.digits; ++digits) {
      checkpoint.show(fmt::format("{} on {}, 1e-{}", method.name, scene.name, digits));
      const double tolerance = std::pow(10.0, -digits);
      all.runs.push_back(
          checkpoint.once(fmt::format("{} {}", method.name, digits), [&] { return measure(method, tolerance); }));
    }
    checkpoint.advance();
  });
  return all;
}

/// How many runs of a method have become what.
struct MethodSummary {
  std::string method;
  std::int64_t runs = 0, within = 0, over = 0, under = 0, explodes = 0, fails = 0;
  double lowest = INFINITY, highest = 0;  ///< of error to tolerance

  void count(const ControlledRun& run) {
    ++runs;
    switch (run.proportion) {
      case Proportion::within: ++within; break;
      case Proportion::over: ++over; break;
      case Proportion::under: ++under; break;
      case Proportion::explodes: ++explodes; break;
      case Proportion::fails: ++fails; break;
    }
    if (!std::isfinite(run.error)) return;
    lowest = std::min(lowest, run.ratio());
    highest = std::max(highest, run.ratio());
  }

  results::Verdict verdict() const {
    if (fails + explodes == runs) return results::Verdict{Standing::open, "no run ends"};
    return results::check(over + fails == 0, "proportional", "not proportional");
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
     [](const MethodSummary& summary) -> Datum { return summary.verdict(); }},
};

/// The summary of all scenes and tolerances.
results::Table tolerance_summary(const std::vector<ControlledRuns>& all, const Methods& methods) {
  std::vector<MethodSummary> rows;
  for (const Method* const method : methods) {
    MethodSummary& row = rows.emplace_back(MethodSummary{std::string(method->name)});
    for (const ControlledRuns& scene : all)
      for (const ControlledRun& run : scene.runs)
        if (run.method == method->name) row.count(run);
  }
  return results::make_table("tolerance-summary", "Error over tolerance, all scenes and tolerances", method_summary_columns,
                             rows);
}

std::vector<results::Table> tolerance_tables(const std::vector<ControlledRuns>& all, const Methods& methods) {
  std::vector<results::Table> tables;
  for (const auto& [setting, scene, runs] : all)
    tables.push_back(results::make_table("tolerance-" + setting, "Error over tolerance on " + scene, controlled_columns, runs));
  tables.push_back(tolerance_summary(all, methods));
  return tables;
}

}  // namespace

std::vector<Job> tolerance(const Question& question) {
  const Methods methods = converging_or(question.methods);
  const std::vector<Setting> list = settings(question.quick);
  const auto compute = [=](Checkpoint& checkpoint) {
    std::vector<ControlledRuns> all;
    checkpoint.each(list, [&](const Setting& setting) { all.push_back(tolerances_on(setting, methods, checkpoint)); });
    return all;
  };
  const auto present = [=](const auto& all) { return tolerance_tables(all, methods); };
  return {job("tolerance", static_cast<int>(list.size() * (1 + methods.size())), compute, present)};
}

}  // namespace drape::bench
