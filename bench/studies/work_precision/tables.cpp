#include "bench/studies/work_precision/tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/studies/work_precision/peers.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "reference/sundials/sundials_build.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {
namespace {

using results::TableBuilder;

/// CPU times of a over those of b, with the interval of its uncertainty.
void add_ratio(TableBuilder& table, const std::string& key, const std::string& description, const Winner& a, const Winner& b) {
  const auto interval = results::ratio_of_medians(a.trial->measured, b.trial->measured);
  table.number(key.c_str(), "ratio", "1", description.c_str(), a.time / b.time);
  table.number((key + "_lower").c_str(), "", "1", "its 95 % interval, by bootstrap", interval.lower);
  table.number((key + "_upper").c_str(), "", "1", "its 95 % interval, by bootstrap", interval.upper);
}

void add_winner(TableBuilder& table, const std::string& key, const std::string& title, const Winner& winner,
                const Winner& best) {
  const auto column = [&](const char* suffix) { return key + suffix; };
  if (!winner) return;
  const auto q = results::quartiles(winner.trial->measured.times);
  table.text(column("").c_str(), "", "the quickest", winner.name());
  table.number(column("_ms").c_str(), title.c_str(), "ms", "its median CPU time", q.median);
  table.number(column("_lower").c_str(), "", "ms", "lower quartile of its times", q.lower);
  table.number(column("_upper").c_str(), "", "ms", "upper quartile of its times", q.upper);
  if (!best) return;
  add_ratio(table, key + "_ratio", "over our best", winner, best);
  if (tie(winner, best)) table.text(column("_tie").c_str(), "", "whether the gap is below the noise", "tie");
}

/// The size of the search on each side, and what part of the motion an error is.
void add_search(TableBuilder& table, const SceneTrials& scene) {
  table.count("our_families", "", "families of ours that were tried", number_of_families(scene, true));
  table.count("sundials_families", "", "families of SUNDIALS that were tried", number_of_families(scene, false));
  if (scene.problem.motion > 0)
    table.number("motion", "", "1", "largest distance from the start, over the scene's size", scene.problem.motion);
}

constexpr const char* sides[] = {"ours", "defaults", "sundials"};

void add_side(TableBuilder& table, const std::string& key, const std::string& title, const Winner& winner) {
  table.text(key.c_str(), title.c_str(), "the family with the value that is the quickest", winner.name());
  if (winner) table.number((key + "_ms").c_str(), "CPU", "ms", "its median CPU time", winner.time);
}

/// `chosen`: the winner of a side.
template <class Chosen>
void add_sides(TableBuilder& table, const Chosen& chosen) {
  const Winner theirs = chosen("sundials");
  add_side(table, "sundials", "SUNDIALS", theirs);
  for (const std::string side : {"ours", "defaults"}) {
    const Winner mine = chosen(side.c_str());
    add_side(table, side, side == "ours" ? "ours" : "auto", mine);
    if (mine && theirs) add_ratio(table, side + "_ratio", "CPU time of SUNDIALS over it", theirs, mine);
  }
}

/// What other codes reach on peer-edge with 100 x 100 particles [m, s per simulated second].
struct Figure {
  const char* code;
  double error, seconds;
};
constexpr Figure figures[] = {{"Bullet, softbody", 0.53, 0.76},
                              {"Bullet, deformable cloth, implicit", 0.053, 21.7},
                              {"Bullet, deformable cloth, explicit", 2e-4, 29},
                              {"XPBD, 20 sub-steps", 0.049, 2.1},
                              {"XPBD, 100 sub-steps", 4e-3, 10.4},
                              {"projective dynamics, 10 iterations", 0.098, 2.9},
                              {"STARK (Newton, implicit Euler)", 0.051, 18.3},
                              {"ARCSim", 0.072, 29},
                              {"a plain vectorised leapfrog", 1.2e-4, 0.59}};

}  // namespace

int number_of_families(const SceneTrials& scene, bool ours) {
  return static_cast<int>(
      std::ranges::count_if(scene.families, [=](const Family& family) { return is_ours(family.code) == ours; }));
}

results::Table trials_table(const SceneTrials& scene) {
  TableBuilder table("trials: " + scene.problem.name, "All that was tried on " + scene.problem.name);
  for (const Trial& trial : scene.trials) {
    table.row();
    table.text("code", "", "whose it is", trial.family->code);
    table.text("family", "", "ways that differ in one number", trial.family->name);
    table.text("method", "", "ours with the program's defaults: the method", trial.family->method);
    table.text("build", "", "how the program and SUNDIALS were built", reference::sundials_build());
    table.text("control", "", "the number: step [s], tolerance, or fraction of the stability limit", trial.family->control);
    table.number("value", "", "1", "its value", trial.configuration().value);
    table.text("outcome", "", "success, or why there is none", trial.outcome);
    table.number("uncertainty", "", "1", "of the reference, as the error", scene.problem.uncertainty);
    table.count("steps", "", "steps", trial.steps);
    table.count("forces", "", "evaluations of forces", trial.forces);
    table.count("factorisations", "", "matrices factored", trial.factorisations);
    if (trial.measured.times.empty()) continue;
    const auto q = results::quartiles(trial.measured.times);
    table.number("error", "", "1", "largest distance from the reference at all tenths of the end, over the scene's size",
                 trial.measured.error);
    table.number("time", "", "ms", "median CPU time", q.median);
    table.number("lower", "", "ms", "lower quartile", q.lower);
    table.number("upper", "", "ms", "upper quartile", q.upper);
    table.count("repetitions", "", "times it was run for this", std::ssize(trial.measured.times));
  }
  return table.finish();
}

results::Table winners_table(const std::vector<SceneTrials>& scenes) {
  const std::string usual = usual_choice(scenes);
  TableBuilder table(
      "winners", fmt::format("With hindsight: the quickest with an error of at most so much, and ratios to our best; usual: "
                             "{}; auto: the best method with automatic stages and linear solvers; {}",
                             usual, reference::sundials_build()));
  for (const SceneTrials& scene : scenes) {
    const Winners winners(scene);
    for (const double error : levels(scene.problem)) {
      const Winner best = winners.of("ours", error);
      table.row();
      table.text("scene", "scene", "its name", scene.problem.name);
      table.number("error", "error", "1", "at most, over the scene's size", error);
      add_search(table, scene);
      if (best) table.text("best", "our best", "the quickest of all that the program offers", best.name());
      add_winner(table, "ours", "ours", best, {});
      add_winner(table, "defaults", "auto", winners.of("defaults", error), best);
      add_winner(table, "usual", "usual", winners.of(usual, error), best);
      add_winner(table, "explicit", "explicit", winners.of("explicit", error), best);
      add_winner(table, "thesis", "thesis", winners.of("thesis", error), best);
      add_winner(table, "sundials", "SUNDIALS", winners.of("sundials", error), best);
      for (const std::string& package : packages()) add_winner(table, package, package, winners.of(package, error), best);
    }
  }
  return table.finish();
}

std::set<std::string> named_families(const SceneTrials& scene) {
  std::set<std::string> names{advised_peer(), advised_ours};
  if (scene.training == nullptr) return names;
  const Winners training(*scene.training);
  for (const double error : levels(scene.problem))
    for (const char* side : sides)
      if (const Winner winner = training.of(side, error)) names.insert(winner.trial->family->name);
  return names;
}

results::Table held_out_table(const std::vector<SceneTrials>& scenes) {
  TableBuilder table("held-out", fmt::format("Families that were the quickest on another scene, judged on this one; {}",
                                             reference::sundials_build()));
  for (const SceneTrials& scene : scenes) {
    if (scene.training == nullptr) continue;
    const Winners winners(scene), training(*scene.training);
    for (const double error : levels(scene.problem)) {
      const auto chosen = [&](const char* side) {
        const Winner winner = training.of(side, error);
        return winner ? winners.of(winner.trial->family->name, error) : Winner{};
      };
      table.row();
      table.text("scene", "scene", "where it is judged", scene.problem.name);
      table.text("training", "chosen on", "where the families were chosen", scene.training->problem.name);
      table.number("error", "error", "1", "at most, over the scene's size", error);
      add_search(table, scene);
      add_sides(table, chosen);
    }
  }
  return table.finish();
}

results::Table recommended_table(const std::vector<SceneTrials>& scenes) {
  TableBuilder table("recommended", fmt::format("One setting of each side for all: {} and {}; {}", advised_ours, advised_peer(),
                                                reference::sundials_build()));
  for (const SceneTrials& scene : scenes) {
    if (is_peer_edge(scene)) continue;
    const Winners winners(scene);
    for (const double error : levels(scene.problem)) {
      const Winner ours = winners.of(advised_ours, error), theirs = winners.of(advised_peer(), error);
      table.row();
      table.text("scene", "scene", "its name", scene.problem.name);
      table.number("error", "error", "1", "at most, over the scene's size", error);
      add_side(table, "ours", "ours", ours);
      add_side(table, "sundials", "SUNDIALS", theirs);
      if (ours && theirs) add_ratio(table, "ratio", "CPU time of SUNDIALS over ours", theirs, ours);
    }
  }
  return table.finish();
}

results::Table defaults_table(const std::vector<SceneTrials>& scenes) {
  TableBuilder table("defaults",
                     "Methods with automatic stages and linear solvers against our best choice, over all scenes and errors");
  for (const Score& score : scores(scenes)) {
    table.row();
    table.text("choice", "choice", "a method and what controls its accuracy", score.contender.substr(8));
    table.count("cells", "cells", "scenes and errors", score.cells);
    table.count("missed", "missed", "of these not reached", score.missed);
    table.count("within", "within 1.5", "of these at most 1.5 times our best, or tied with it", score.within);
    table.number("mean", "mean", "1", "geometric mean of the ratios to our best, those not reached as 10", score.mean());
    table.number("worst", "worst", "1", "the largest", score.worst);
  }
  return table.finish();
}

std::vector<double> peer_errors() {
  std::vector<double> errors;
  for (const PeerBar& bar : peer_bars) errors.push_back(bar.error);
  for (const Figure& figure : figures) errors.push_back(figure.error);
  return errors;
}

results::Table peers_table(const std::vector<SceneTrials>& scenes) {
  TableBuilder table(
      "peer-edge", "Other codes on their own machine, and what is the quickest of ours with errors at most theirs on this one");
  for (const SceneTrials& scene : scenes) {
    if (!is_peer_edge(scene)) continue;
    const Winners winners(scene);
    const int n = scene.problem.scene.sheet.grid.nu;
    for (const Figure& figure : figures) {
      table.row();
      table.count("n", "n", "particles a side", n);
      table.text("code", "other code, 100 x 100", "measured elsewhere", figure.code);
      table.number("their_error", "error", "m", "RMS at 0.5 s", figure.error);
      if (n == 100) table.number("their_seconds", "time", "s/s", "CPU seconds per simulated second", figure.seconds);
      const auto show = [&](const char* contender, const char* title, const char* description) {
        const Winner winner = winners.of(contender, figure.error);
        if (!winner) return;
        const double time = 1e-3 * winner.time / scene.problem.times.back();
        table.text(contender, title, description, winner.name());
        table.number(fmt::format("{}_error", contender).c_str(), "error", "m", "RMS, the largest at all tenths of the end",
                     winner.trial->measured.error);
        table.number(fmt::format("{}_seconds", contender).c_str(), "time", "s/s", "CPU seconds per simulated second", time);
      };
      show("ours", "ours", "the quickest at most as far off");
      show("implicit", "implicit", "the quickest implicit method at most as far off");
    }
  }
  return table.finish();
}

}  // namespace drape::bench
