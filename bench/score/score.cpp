#include "bench/score/score.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "bench/runs/identity.hpp"
#include "bench/runs/reference_reports.hpp"
#include "bench/score/scoring.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "solver/base/hash.hpp"

namespace drape::bench {
namespace {

using results::ColumnGroup;
using results::ColumnOf;
using results::Datum;
using results::field;
using results::make_table;
using results::Measured;
using results::quartiles;
using results::Role;
using results::Table;
using results::to_datum;

/// A frame in units of the scene's size.
struct Frame {
  const FrameScore* score;
  double size;
};

constexpr ColumnOf<Frame> frame_columns[] = {
    {"t", "t", "s", "time of the frame", Role::key, [](const Frame& f) -> Datum { return f.score->t; }},
    {"rms", "rms error", "1", "distance from the reference, over the size", Role::error,
     [](const Frame& f) -> Datum { return f.score->rms / f.size; }},
    {"maximum", "largest", "1", "largest distance of a particle, over the size", Role::error,
     [](const Frame& f) -> Datum { return f.score->maximum / f.size; }},
    {"reference_error", "reference error", "1", "uncertainty of the reference, as rms", Role::uncertainty,
     [](const Frame& f) -> Datum { return f.score->uncertainty / f.size; }},
    {"centre", "", "1", "distance of the centres of mass, over the size", Role::error,
     [](const Frame& f) -> Datum { return f.score->centre / f.size; }},
    {"centre_uncertainty", "", "1", "of the reference", Role::note,
     [](const Frame& f) -> Datum { return f.score->truth.centre_distance / f.size; }},
};

/// An energy of a frame and of the reference [J].
struct Energy {
  double own, truth, uncertainty;
};

constexpr ColumnOf<Energy> energy_columns[] = {
    {"{}", "{}", "J", "energy", Role::quantity, field<&Energy::own>},
    {"reference_{}", "reference", "J", "the same of the reference", Role::quantity, field<&Energy::truth>},
    {"{}_uncertainty", "", "J", "of the reference", Role::note, field<&Energy::uncertainty>},
};

constexpr ColumnOf<FrameScore> depth_columns[] = {
    {"depth", "depth", "m", "greatest depth of a particle in an obstacle", Role::quantity, field<&FrameScore::depth>},
    {"reference_depth", "reference", "m", "the same of the reference", Role::quantity, field<&FrameScore::true_depth>},
};

Table frames_table(const Scoring& s) {
  std::vector<Frame> rows;
  for (const FrameScore& frame : s.frames) rows.push_back({&frame, s.size()});
  Table table =
      make_table("score",
                 fmt::format("{} on {}, frame by frame; reference {}; energies by our model{}", s.external.name, s.scene.name,
                             s.truth.families, s.external.differenced ? ", velocities by differences of the frames" : ""),
                 frame_columns, rows);
  const auto add_energies = [&](double Observables::*which, const ColumnGroup& group) {
    const auto energy = [&](const FrameScore& frame) {
      return std::optional(Energy{frame.own.*which, frame.truth.value.*which, frame.truth.uncertainty.*which});
    };
    add_columns(table, energy_columns, s.frames, energy, group);
  };
  add_energies(&Observables::kinetic, {"kinetic", "kinetic", ""});
  add_energies(&Observables::potential, {"potential", "potential", ""});
  add_energies(&Observables::total, {"energy", "total", ""});
  if (s.truth.cloth.contacts) add_columns(table, depth_columns, s.frames);
  return table;
}

constexpr const char* by_reference = "by what the reference is uncertain";

constexpr ColumnOf<Summary> summary_columns[] = {
    {"scene", "", "", "its name", Role::key, [](const Summary& s) -> Datum { return s.scoring->scene.name; }},
    {"file", "", "", "what was measured", Role::key, [](const Summary& s) -> Datum { return s.scoring->external.name; }},
    {"velocities", "", "", "where they are from", Role::key,
     [](const Summary& s) { return to_datum(source_of_velocities(s.scoring->external)); }},
    {"reference", "", "", "the families that agree", Role::note,
     [](const Summary& s) -> Datum { return s.scoring->truth.families; }},
    {"frames", "", "1", "how many", Role::quantity, [](const Summary& s) -> Datum { return std::ssize(s.scoring->frames); }},
    {"end", "", "s", "time of the last frame", Role::quantity, [](const Summary& s) -> Datum { return s.last->t; }},
    {"growth", "", "1", "largest growth of a small perturbation of the start", Role::quantity,
     [](const Summary& s) -> Datum { return s.scoring->truth.growth; }},
    {"error", "rms error", "1", "largest of the frames' rms distances, over the size", Role::error, field<&Summary::error>},
    {"error_time", "at", "s", "when that is", Role::quantity, [](const Summary& s) -> Datum { return s.worst->t; }},
    {"maximum", "largest", "1", "largest distance of any particle in any frame, over the size", Role::error,
     field<&Summary::maximum>},
    {"mean_error", "", "1", "root mean square over all frames and particles, over the size", Role::error,
     field<&Summary::mean_error>},
    {"end_error", "at the end", "1", "rms distance of the last frame, over the size", Role::error, field<&Summary::end_error>},
    {"reference_error", "reference error", "1", "largest uncertainty of the reference at the frames, as rms", Role::uncertainty,
     field<&Summary::reference_error>},
    {"lag", "lag", "s", "delay against the reference", Role::quantity,
     [](const Summary& s) -> Datum { return s.late.seconds.value; }},
    {"lag_uncertainty", "±", "s", by_reference, Role::note,
     [](const Summary& s) -> Datum { return s.late.seconds.uncertainty; }},
    {"left", "left", "1", "as mean_error, the delay taken out", Role::error,
     [](const Summary& s) -> Datum { return s.late.left.value; }},
    {"left_uncertainty", "±", "1", by_reference, Role::note, [](const Summary& s) -> Datum { return s.late.left.uncertainty; }},
    {"damping", "damping", "1/s", "rate at which the kinetic energy falls behind the reference's, the delay taken out",
     Role::quantity, [](const Summary& s) -> Datum { return s.damping.value; }},
    {"damping_uncertainty", "±", "1/s", by_reference, Role::note,
     [](const Summary& s) -> Datum { return s.damping.uncertainty; }},
    {"energy", "", "J", "total at the last frame", Role::quantity, [](const Summary& s) -> Datum { return s.last->own.total; }},
    {"energy_uncertainty", "", "J", by_reference, Role::note,
     [](const Summary& s) -> Datum { return s.last->truth.uncertainty.total; }},
    {"reference_energy", "", "J", "the same of the reference", Role::quantity,
     [](const Summary& s) -> Datum { return s.last->truth.value.total; }},
};

constexpr ColumnOf<Summary> penetration_columns[] = {
    {"penetration", "depth", "m", "greatest depth of a particle in an obstacle", Role::quantity,
     [](const Summary& s) -> Datum { return s.deepest->depth; }},
    {"penetration_time", "at", "s", "when that is", Role::quantity, [](const Summary& s) -> Datum { return s.deepest->t; }},
    {"reference_penetration", "", "m", "the same of the reference", Role::quantity, field<&Summary::reference_depth>},
};

/// A number over another.
Uncertain over(const Uncertain& number, double divisor) { return {number.value / divisor, number.uncertainty / divisor}; }

Summary summarised(const Scoring& s) {
  const auto largest = [&](double FrameScore::*value) { return &*std::ranges::max_element(s.frames, {}, value); };
  const FrameScore *worst = largest(&FrameScore::rms), *last = &s.frames.back();
  const double size = s.size();
  double mean = 0;
  for (const FrameScore& frame : s.frames) mean += frame.rms * frame.rms / static_cast<double>(s.frames.size());
  const Lag late = lag(s.external, s.truth);
  return {.scoring = &s,
          .worst = worst,
          .last = last,
          .deepest = largest(&FrameScore::depth),
          .error = worst->rms / size,
          .maximum = largest(&FrameScore::maximum)->maximum / size,
          .mean_error = std::sqrt(mean) / size,
          .end_error = last->rms / size,
          .reference_error = largest(&FrameScore::uncertainty)->uncertainty / size,
          .reference_depth = largest(&FrameScore::true_depth)->true_depth,
          .late = {late.seconds, over(late.left, size)},
          .damping = damping(s.external, s.truth, late)};
}

Table summary_table(const Summary& summary) {
  const std::array rows{summary};
  const Scoring& s = *summary.scoring;
  Table table =
      make_table("score-summary", fmt::format("{} on {} in numbers", s.external.name, s.scene.name), summary_columns, rows);
  if (s.truth.cloth.contacts) add_columns(table, penetration_columns, rows);
  return table;
}

constexpr const char* of_value = "step [s], or fraction of the stability limit";
constexpr const char* of_error = "largest of the frames' rms distances, over the size";
constexpr const char* of_time = "median wall time to the last frame";

constexpr ColumnOf<ComparedRun> run_columns[] = {
    {"method", "", "", "time integrator, with what controls it", Role::key,
     [](const ComparedRun& run) -> Datum { return run.configuration->name; }},
    {"value", "", "1", of_value, Role::key, [](const ComparedRun& run) -> Datum { return run.variant().value; }},
    {"outcome", "", "", "success, or why there is none", Role::outcome,
     [](const ComparedRun& run) -> Datum { return run.counts() ? "success" : run.reason; }},
    {"steps", "", "1", "steps", Role::counter, field<&ComparedRun::steps>},
};

constexpr ColumnOf<Measured> measured_columns[] = {
    {"error", "", "1", of_error, Role::error, field<&Measured::error>},
    {"time", "", "ms", of_time, Role::time, [](const Measured& m) -> Datum { return quartiles(m.times).median; }},
    {"lower", "", "ms", "lower quartile", Role::time, [](const Measured& m) -> Datum { return quartiles(m.times).lower; }},
    {"upper", "", "ms", "upper quartile", Role::time, [](const Measured& m) -> Datum { return quartiles(m.times).upper; }},
    {"repetitions", "", "1", "times it was run for this", Role::time,
     [](const Measured& m) -> Datum { return std::ssize(m.times); }},
};

/// All that was tried, for files.
Table trials(const Scoring& s) {
  Table table = make_table("score-trials", "All that was tried of our methods", run_columns, s.ours.runs);
  add_columns(table, measured_columns, s.ours.runs,
              [](const ComparedRun& run) { return run.measured.times.empty() ? nullptr : &run.measured; });
  table.timed_rows = table.for_file = true;
  return table;
}

/// A run that answers a question, and whether no other method answers it better.
struct Answer {
  const ComparedRun* run;
  bool best;
};

/// What one of our configurations answers.
struct OfConfiguration {
  std::string method;
  std::optional<Answer> as_right, at_cost;
};

constexpr ColumnOf<OfConfiguration> configuration_columns[] = {
    {"method", "method", "", "time integrator, with what controls it", Role::key, field<&OfConfiguration::method>},
};

/// Which run it is depends on times.
constexpr ColumnOf<Answer> answer_columns[] = {
    {"{}value", "{}", "1", of_value, Role::time, [](const Answer& a) -> Datum { return a.run->variant().value; }},
    {"{}error", "rms error", "1", of_error, Role::time, [](const Answer& a) -> Datum { return a.run->measured.error; }},
    {"{}time", "time", "ms", of_time, Role::time,
     [](const Answer& a) -> Datum { return quartiles(a.run->measured.times).median; }},
    {"{}best", "best", "", "which method it is", Role::note,
     [](const Answer& a) { return a.best ? to_datum("best") : Datum(); }},
};

std::optional<Answer> answer(const ComparedRun* run, const ComparedRun* best) {
  if (run == nullptr) return std::nullopt;
  return Answer{run, run == best};
}

Table answers_table(const Scoring& s) {
  std::vector<OfConfiguration> rows;
  for (std::size_t k = 0; k < s.ours.configurations.size(); ++k) {
    const Answers &answers = s.ours.answers[k], &best = s.ours.best;
    rows.push_back(
        {s.ours.configurations[k].name, answer(answers.as_right, best.as_right), answer(answers.at_cost, best.at_cost)});
  }
  const std::optional<double> cost = s.options.cost;
  Table table =
      make_table("score-ours",
                 fmt::format("Our methods on {} to {:g} s: the quickest at most as wrong as {} (rms error {:.3g}){}",
                             s.scene.name, s.frames.back().t, s.external.name, known_error(s.frames) / s.size(),
                             cost ? fmt::format(", and the least wrong that take no longer ({:g} ms)", 1e3 * *cost) : ""),
                 configuration_columns, rows);
  add_columns(table, answer_columns, rows, std::mem_fn(&OfConfiguration::as_right), {"", "as right with", ""});
  if (cost) add_columns(table, answer_columns, rows, std::mem_fn(&OfConfiguration::at_cost), {"cost_", "no longer with", ""});
  return table;
}

Scoring scored(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options, Checkpoint& checkpoint) {
  const auto truth = [&] {
    ReferenceReports reports(checkpoint, scene.name);
    return true_motion(scene, external.times, options.agreement, {.say = std::ref(reports)});
  };
  Scoring s{scene, external, options, truth(), {}, {}};
  s.frames = frame_scores(s.external, s.truth);
  checkpoint.advance();
  s.ours = try_ours(s.truth, s.frames, options.methods, options.cost, options.repetitions, checkpoint);
  return s;
}

Results present(const Scoring& s) {
  const Summary summary = summarised(s);
  return {.tables = {frames_table(s), summary_table(summary), answers_table(s), trials(s)}, .summary = in_words(summary)};
}

std::string bits(const std::vector<solver::State>& states) {
  std::string all;
  for (const solver::State& y : states)
    for (const solver::Vectors* part : {&y.x, &y.v})
      all.append(reinterpret_cast<const char*>(part->data()), static_cast<std::size_t>(part->size()) * sizeof(double));
  return all;
}

}  // namespace

const char* source_of_velocities(const ExternalMotion& external) {
  return external.differenced ? "differences of the frames" : "the file";
}

Job score_job(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options) {
  return job(
      "score", 1 + static_cast<int>(options.methods.size()),
      [=](Checkpoint& checkpoint) { return scored(scene, external, options, checkpoint); }, present);
}

std::string score_identity(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options) {
  return base::long_hash_text(fmt::format("score\n{}\n{} {} {}\n{} {} {} {}\n{}", model::to_toml(scene), external.name,
                                          external.differenced, fmt::join(external.times, " "), fmt::join(options.methods, " "),
                                          options.cost.value_or(0), options.agreement, options.repetitions,
                                          bits(external.states)));
}

}  // namespace drape::bench
