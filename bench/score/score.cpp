#include "bench/score/score.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "bench/runs/identity.hpp"
#include "bench/score/ours.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {
namespace {

using results::Table;
using results::TableBuilder;

/// What the tables share.
struct Scoring {
  model::Scene scene;
  ExternalMotion external;
  ScoreOptions options;
  std::optional<TrueMotion> truth;
  std::vector<FrameScore> frames;
  Ours ours;

  double size() const { return model::size(scene); }
};

void add_energies(TableBuilder& table, const FrameScore& frame) {
  const Observables &own = frame.own, &truth = frame.truth.value, &unsure = frame.truth.uncertainty;
  const auto energy = [&](const std::string& name, const char* title, double Observables::*which) {
    table.number(name.c_str(), title, "J", "energy", own.*which);
    table.number(("reference_" + name).c_str(), "reference", "J", "the same of the reference", truth.*which);
    table.number((name + "_uncertainty").c_str(), "", "J", "of the reference", unsure.*which);
  };
  energy("kinetic", "kinetic", &Observables::kinetic);
  energy("potential", "potential", &Observables::potential);
  energy("energy", "total", &Observables::total);
}

Table over_time(Scoring& s, Checkpoint& checkpoint) {
  checkpoint.show("reference of " + s.scene.name);
  const auto say = [&](const std::string& pace) { checkpoint.report("reference of " + s.scene.name + ": " + pace); };
  s.truth = true_motion(s.scene, s.external.times, s.options.agreement, {.say = say});
  s.frames = frame_scores(s.external, *s.truth);
  checkpoint.advance();
  TableBuilder table(
      "score", fmt::format("{} on {}, frame by frame; reference {}; energies by our model{}", s.external.name, s.scene.name,
                           s.truth->families, s.external.differenced ? ", velocities by differences of the frames" : ""));
  for (const FrameScore& frame : s.frames) {
    table.row();
    table.number("t", "t", "s", "time of the frame", frame.t);
    table.number("rms", "rms error", "1", "distance from the reference, over the size", frame.rms / s.size());
    table.number("maximum", "largest", "1", "largest distance of a particle, over the size", frame.maximum / s.size());
    table.number("reference_error", "reference error", "1", "uncertainty of the reference, as rms",
                 frame.uncertainty / s.size());
    table.number("centre", "", "1", "distance of the centres of mass, over the size", frame.centre / s.size());
    table.number("centre_uncertainty", "", "1", "of the reference", frame.truth.centre_distance / s.size());
    add_energies(table, frame);
    if (!s.truth->cloth.contacts) continue;
    table.number("depth", "depth", "m", "greatest depth of a particle in an obstacle", frame.depth);
    table.number("reference_depth", "reference", "m", "the same of the reference", frame.true_depth);
  }
  return table.finish();
}

/// A column and one for its uncertainty.
void add(TableBuilder& table, const std::string& name, const char* title, const char* unit, const char* description,
         const Uncertain& number, double divided_by = 1) {
  table.number(name.c_str(), title, unit, description, number.value / divided_by);
  table.number((name + "_uncertainty").c_str(), *title == 0 ? "" : "±", unit, "by what the reference is uncertain",
               number.uncertainty / divided_by);
}

Table summary(const Scoring& s) {
  const double size = s.size();
  TableBuilder table("score-summary", fmt::format("{} on {} in numbers", s.external.name, s.scene.name));
  const FrameScore &worst = std::ranges::max(s.frames, {}, &FrameScore::rms), &last = s.frames.back();
  double mean = 0;
  for (const FrameScore& frame : s.frames) mean += frame.rms * frame.rms / static_cast<double>(s.frames.size());
  table.row();
  table.text("scene", "", "its name", s.scene.name);
  table.text("file", "", "what was measured", s.external.name);
  table.text("velocities", "", "where they are from", s.external.differenced ? "differences of the frames" : "the file");
  table.text("reference", "", "the families that agree", s.truth->families);
  table.count("frames", "", "how many", std::ssize(s.frames));
  table.number("end", "", "s", "time of the last frame", last.t);
  table.number("growth", "", "1", "largest growth of a small perturbation of the start", s.truth->growth);
  table.number("error", "rms error", "1", "largest of the frames' rms distances, over the size", worst.rms / size);
  table.number("error_time", "at", "s", "when that is", worst.t);
  table.number("maximum", "largest", "1", "largest distance of any particle in any frame, over the size",
               std::ranges::max(s.frames, {}, &FrameScore::maximum).maximum / size);
  table.number("mean_error", "", "1", "root mean square over all frames and particles, over the size", std::sqrt(mean) / size);
  table.number("end_error", "at the end", "1", "rms distance of the last frame, over the size", last.rms / size);
  table.number("reference_error", "reference error", "1", "largest uncertainty of the reference at the frames, as rms",
               std::ranges::max(s.frames, {}, &FrameScore::uncertainty).uncertainty / size);
  const Lag late = lag(s.external, *s.truth);
  add(table, "lag", "lag", "s", "delay against the reference", late.seconds);
  add(table, "left", "left", "1", "as mean_error, the delay taken out", late.left, size);
  add(table, "damping", "damping", "1/s", "rate at which the kinetic energy falls behind the reference's, the delay taken out",
      damping(s.external, *s.truth, late));
  add(table, "energy", "", "J", "total at the last frame", {last.own.total, last.truth.uncertainty.total});
  table.number("reference_energy", "", "J", "the same of the reference", last.truth.value.total);
  if (!s.truth->cloth.contacts) return table.finish();
  const FrameScore& deepest = std::ranges::max(s.frames, {}, &FrameScore::depth);
  table.number("penetration", "depth", "m", "greatest depth of a particle in an obstacle", deepest.depth);
  table.number("penetration_time", "at", "s", "when that is", deepest.t);
  table.number("reference_penetration", "", "m", "the same of the reference",
               std::ranges::max(s.frames, {}, &FrameScore::true_depth).true_depth);
  return table.finish();
}

/// All that was tried, for files.
Table trials(const Scoring& s) {
  TableBuilder table("score-trials", "All that was tried of our methods");
  for (const Trial& trial : s.ours.trials) {
    table.row();
    table.text("method", "", "time integrator, with what controls it", trial.family->name);
    table.number("value", "", "1", "step [s], or fraction of the stability limit", trial.configuration().value);
    table.text("outcome", "", "success, or why there is none", trial.outcome);
    table.count("steps", "", "steps", trial.steps);
    if (trial.measured.times.empty()) continue;
    const results::Quartiles q = results::quartiles(trial.measured.times);
    table.number("error", "", "1", "largest of the frames' rms distances, over the size", trial.measured.error);
    table.number("time", "", "ms", "median wall time to the last frame", q.median);
    table.number("lower", "", "ms", "lower quartile", q.lower);
    table.number("upper", "", "ms", "upper quartile", q.upper);
    table.count("repetitions", "", "times it was run for this", std::ssize(trial.measured.times));
  }
  return table.finish();
}

/// A trial in columns whose names begin with `prefix`.
void add_answer(TableBuilder& table, const std::string& prefix, const char* question, const Trial* trial, bool best) {
  if (trial == nullptr) return;
  const auto name = [&](const char* end) { return prefix + end; };
  table.number(name("value").c_str(), question, "1", "step [s], or fraction of the stability limit",
               trial->configuration().value);
  table.number(name("error").c_str(), "rms error", "1", "largest of the frames' rms distances, over the size",
               trial->measured.error);
  table.number(name("time").c_str(), "time", "ms", "median wall time to the last frame",
               results::quartiles(trial->measured.times).median);
  if (best) table.text(name("best").c_str(), "best", "which method it is", "best");
}

Table beside_ours(Scoring& s, Checkpoint& checkpoint) {
  s.ours = try_ours(*s.truth, s.frames, s.options.methods, s.options.cost, s.options.repetitions, checkpoint);
  const double error = known_error(s.frames) / s.size();
  TableBuilder table(
      "score-ours",
      fmt::format(
          "Our methods on {} to {:g} s: the quickest at most as wrong as {} (rms error {:.3g}){}", s.scene.name,
          s.frames.back().t, s.external.name, error,
          s.options.cost ? fmt::format(", and the least wrong that take no longer ({:g} ms)", 1e3 * *s.options.cost) : ""));
  for (std::size_t k = 0; k < s.ours.families.size(); ++k) {
    const Answers &answers = s.ours.answers[k], &best = s.ours.best;
    table.row();
    table.text("method", "method", "time integrator, with what controls it", s.ours.families[k].name);
    add_answer(table, "", "as right with", answers.as_right, answers.as_right == best.as_right);
    add_answer(table, "cost_", "no longer with", answers.at_cost, answers.at_cost == best.at_cost);
  }
  Table ours = table.finish();
  std::stable_partition(ours.columns.begin(), ours.columns.end(),
                        [](const results::Column& column) { return !column.name.starts_with("cost_"); });
  return ours;
}

std::string bits(const std::vector<solver::State>& states) {
  std::string all;
  for (const solver::State& y : states)
    for (const solver::Vectors* part : {&y.x, &y.v})
      all.append(reinterpret_cast<const char*>(part->data()), static_cast<std::size_t>(part->size()) * sizeof(double));
  return all;
}

}  // namespace

std::vector<TableJob> score_jobs(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options) {
  const auto shared = std::make_shared<Scoring>(Scoring{scene, external, options, {}, {}, {}});
  return {{1, [=](Checkpoint& checkpoint) { return over_time(*shared, checkpoint); }},
          {0, [=](Checkpoint&) { return summary(*shared); }},
          {static_cast<int>(options.methods.size()), [=](Checkpoint& checkpoint) { return beside_ours(*shared, checkpoint); }},
          {0, [=](Checkpoint&) { return trials(*shared); }}};
}

std::string score_identity(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options) {
  return hash_of(fmt::format("score\n{}\n{} {} {}\n{} {} {} {}\n{}", model::to_toml(scene), external.name, external.differenced,
                             fmt::join(external.times, " "), fmt::join(options.methods, " "), options.cost.value_or(0),
                             options.agreement, options.repetitions, bits(external.states)));
}

}  // namespace drape::bench
