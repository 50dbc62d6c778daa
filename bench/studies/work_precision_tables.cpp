#include "bench/studies/work_precision_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "reference/families.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {
namespace {

using results::Measured;
using results::TableBuilder;

/// The quickest trial of a contender at an error.
struct Winner {
  const Trial* trial = nullptr;
  double time = NAN;  ///< median [ms]

  explicit operator bool() const { return trial != nullptr; }
  std::string name() const { return fmt::format("{}: {:.2g}", trial->family->name, trial->candidate->value); }
};

/// All winners of a scene: the contenders' quickest at each level.
class Winners {
 public:
  explicit Winners(const SceneTrials& scene) : scene_(scene), contenders_(contenders(scene.trials)) {}

  Winner of(const std::string& contender, double error) const {
    const auto found = std::ranges::find(contenders_, contender, &Contender::name);
    if (found == contenders_.end()) return {};
    const auto best = results::quickest(timed(*found, scene_.trials), error);
    if (!best) return {};
    const Trial& trial = scene_.trials[found->members[*best]];
    return {&trial, results::quartiles(trial.measured.times).median};
  }

 private:
  const SceneTrials& scene_;
  std::vector<Contender> contenders_;
};

bool tie(const Winner& a, const Winner& b) { return a.trial == b.trial || results::tied(a.trial->measured, b.trial->measured); }

/// Errors that the truth of a scene resolves: 1e-1 to 1e-7.
std::vector<double> levels(const Problem& problem) {
  constexpr double part = 0.3;  // of an error that the truth may be uncertain by
  std::vector<double> all;
  for (int digits = 1; digits <= 7; ++digits)
    if (const double error = std::pow(10.0, -digits); problem.uncertainty <= part * error) all.push_back(error);
  return all;
}

std::vector<std::string> packages() {
  std::vector<std::string> names;
  for (const reference::Family& family : reference::families()) names.emplace_back(family.name);
  return names;
}

/// The quickest of all packages.
Winner best_peer(const Winners& winners, double error) {
  Winner best;
  for (const std::string& package : packages())
    if (const Winner winner = winners.of(package, error); winner && !(best && best.time <= winner.time)) best = winner;
  return best;
}

// --- Defaults ----------------------------------------------------------------------------------------------------------------

/// Ratios of one way to use the program to our best choice.
struct Score {
  std::string contender;
  int cells = 0, missed = 0, within = 0;
  double log_sum = 0, worst = 1;

  double mean() const { return std::exp(log_sum / std::max(1, cells - missed)); }
};

constexpr double default_bar = 1.5;

void add(Score& score, const Winner& best, const Winner& winner) {
  ++score.cells;
  if (!winner) {
    ++score.missed;
    return;
  }
  const double ratio = winner.time / best.time;
  score.log_sum += std::log(ratio);
  score.worst = std::max(score.worst, ratio);
  score.within += ratio <= default_bar || tie(best, winner);
}

/// Best first: by how often it misses, then by the mean ratio.
std::vector<Score> scores(const std::vector<SceneTrials>& scenes) {
  std::vector<Score> all;
  for (const SceneTrials& scene : scenes)
    for (const Contender& contender : contenders(scene.trials))
      if (contender.name.starts_with("default ") && std::ranges::find(all, contender.name, &Score::contender) == all.end())
        all.push_back({contender.name});
  for (const SceneTrials& scene : scenes) {
    const Winners winners(scene);
    for (const double error : levels(scene.problem))
      if (const Winner best = winners.of("ours", error))
        for (Score& score : all) add(score, best, winners.of(score.contender, error));
  }
  std::ranges::sort(all, {}, [](const Score& score) { return std::pair(score.missed, score.mean()); });
  return all;
}

// --- Winners -----------------------------------------------------------------------------------------------------------------

void add_winner(TableBuilder& table, const std::string& key, const std::string& title, const Winner& winner,
                const Winner& best) {
  const auto column = [&](const char* suffix) { return key + suffix; };
  if (!winner) return;
  const auto q = results::quartiles(winner.trial->measured.times);
  table.text(column("").c_str(), "", "the quickest", winner.name());
  table.number(column("_ms").c_str(), title.c_str(), "ms", "its median time", q.median);
  table.number(column("_lower").c_str(), "", "ms", "lower quartile of its times", q.lower);
  table.number(column("_upper").c_str(), "", "ms", "upper quartile of its times", q.upper);
  if (!best) return;
  table.number(column("_ratio").c_str(), "ratio", "1", "over our best", winner.time / best.time);
  if (tie(winner, best)) table.text(column("_tie").c_str(), "", "whether the gap is below the noise", "tie");
}

}  // namespace

results::Table trials_table(const SceneTrials& scene) {
  TableBuilder table("trials: " + scene.problem.name, "All that was tried on " + scene.problem.name);
  for (const Trial& trial : scene.trials) {
    table.row();
    table.text("code", "", "whose it is", trial.family->code);
    table.text("family", "", "ways that differ in one number", trial.family->name);
    table.text("method", "", "ours with the program's defaults: the method", trial.family->method);
    table.text("control", "", "the number: step [s], tolerance, or fraction of the stability limit", trial.family->control);
    table.number("value", "", "1", "its value", trial.candidate->value);
    table.text("outcome", "", "success, or why there is none", trial.outcome);
    table.number("uncertainty", "", "1", "of the reference, as the error", scene.problem.uncertainty);
    table.count("steps", "", "steps", trial.steps);
    table.count("forces", "", "evaluations of forces", trial.forces);
    table.count("factorisations", "", "matrices factored", trial.factorisations);
    if (trial.measured.times.empty()) continue;
    const auto q = results::quartiles(trial.measured.times);
    table.number("error", "", "1", "largest distance from the reference at three times, over the scene's size",
                 trial.measured.error);
    table.number("time", "", "ms", "median wall time", q.median);
    table.number("lower", "", "ms", "lower quartile", q.lower);
    table.number("upper", "", "ms", "upper quartile", q.upper);
    table.count("repetitions", "", "times it was run for this", std::ssize(trial.measured.times));
  }
  return table.finish();
}

results::Table winners_table(const std::vector<SceneTrials>& scenes) {
  const auto all = scores(scenes);
  const std::string usual = all.empty() ? "" : all.front().contender;
  TableBuilder table("winners", fmt::format("The quickest with an error of at most so much, and ratios to our best; usual: {}; "
                                            "auto: the best method with automatic stages and linear solvers",
                                            usual));
  for (const SceneTrials& scene : scenes) {
    const Winners winners(scene);
    for (const double error : levels(scene.problem)) {
      const Winner best = winners.of("ours", error);
      table.row();
      table.text("scene", "scene", "its name", scene.problem.name);
      table.number("error", "error", "1", "at most, over the scene's size", error);
      if (best) table.text("best", "our best", "the quickest of all that the program offers", best.name());
      add_winner(table, "ours", "ours", best, {});
      add_winner(table, "defaults", "auto", winners.of("defaults", error), best);
      add_winner(table, "usual", "usual", winners.of(usual, error), best);
      add_winner(table, "explicit", "explicit", winners.of("explicit", error), best);
      add_winner(table, "thesis", "thesis", winners.of("thesis", error), best);
      for (const std::string& package : packages()) add_winner(table, package, package, winners.of(package, error), best);
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
    table.number("mean", "mean", "1", "geometric mean of the ratios to our best", score.mean());
    table.number("worst", "worst", "1", "the largest", score.worst);
  }
  return table.finish();
}

// --- Bars --------------------------------------------------------------------------------------------------------------------

namespace {

/// A bar asks for a ratio of at least, or at most, so much.
struct Bar {
  std::string name;
  double wanted;
  bool at_least;
};

void add_bar(TableBuilder& table, const SceneTrials& scene, const Bar& bar, double error, std::optional<double> value,
             const std::string& detail) {
  table.row();
  table.text("scene", "scene", "its name", scene.problem.name);
  table.text("bar", "bar", "what is compared", bar.name);
  table.number("error", "error", "1", "at most", error);
  table.text("wanted", "wanted", "what is asked for", fmt::format("{} {:g}", bar.at_least ? ">=" : "<=", bar.wanted));
  table.text("detail", "", "what was compared", detail);
  if (!value) {
    table.text("verdict", "verdict", "whether the bar is met",
               bar.at_least ? "met: only we reach this error" : "NOT met: not reached");
    return;
  }
  table.number("value", "value", "1", "what was measured", *value);
  const double by = bar.at_least ? bar.wanted / *value : *value / bar.wanted;
  table.text("verdict", "verdict", "whether the bar is met", by <= 1 ? "met" : fmt::format("NOT met by {:.2f}", by));
}

double wanted_of_peers(double error) { return error > 3e-4 ? 5 : error > 3e-7 ? 3 : 1; }

void add_bars(TableBuilder& table, const SceneTrials& scene, const std::string& usual) {
  const Winners winners(scene);
  for (const double error : levels(scene.problem)) {
    const Winner best = winners.of("ours", error);
    const auto ratio = [&](const Winner& a) { return a ? std::optional(a.time / best.time) : std::nullopt; };
    const auto names = [&](const Winner& a) { return fmt::format("{} / {}", a ? a.name() : "none", best.name()); };
    if (!best) {
      add_bar(table, scene, {"our best", 1, false}, error, std::nullopt, "none");
      continue;
    }
    if (const Winner peer = best_peer(winners, error); scene.problem.scene.name == "hung-corners")
      add_bar(table, scene, {"SUNDIALS' best / our best", wanted_of_peers(error), true}, error, ratio(peer), names(peer));
    if (const Winner thesis = winners.of("thesis", error))
      add_bar(table, scene, {"thesis' loop / our best", 3, true}, error, ratio(thesis), names(thesis));
    for (const std::string contender : {"defaults", usual.c_str()}) {
      const Winner winner = winners.of(contender, error);
      add_bar(table, scene, {(contender == usual ? usual : "any method, auto") + " / our best", default_bar, false}, error,
              ratio(winner), names(winner));
    }
  }
}

/// On peer-edge times are per simulated second and errors in metres.
void add_peer_bars(TableBuilder& table, const SceneTrials& scene) {
  const Winners winners(scene);
  const double end = scene.problem.times.back();
  const auto seconds = [&](const Winner& winner) { return winner ? std::optional(1e-3 * winner.time / end) : std::nullopt; };
  const auto name = [](const Winner& winner) { return winner ? winner.name() : std::string("none"); };
  const Winner implicit = winners.of("implicit", 5e-2);
  add_bar(table, scene, {"implicit [s per simulated second]", 0.4, false}, 5e-2, seconds(implicit), name(implicit));
  for (const auto& [error, bar] : {std::pair(5e-3, 0.7), {3e-4, 0.5}}) {
    const Winner best = winners.of("ours", error);
    add_bar(table, scene, {"any [s per simulated second]", bar, false}, error, seconds(best), name(best));
  }
}

bool is_peer_edge(const SceneTrials& scene) { return scene.problem.scene.name == "peer-edge"; }

}  // namespace

results::Table bars_table(const std::vector<SceneTrials>& scenes) {
  TableBuilder table("bars", "What was asked for");
  const auto all = scores(scenes);
  const std::string usual = all.empty() ? "" : all.front().contender;
  for (const SceneTrials& scene : scenes) {
    if (!is_peer_edge(scene))
      add_bars(table, scene, usual);
    else if (scene.problem.scene.sheet.grid.nu == 100)
      add_peer_bars(table, scene);
  }
  return table.finish();
}

results::Table peers_table(const std::vector<SceneTrials>& scenes) {
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
        table.number(fmt::format("{}_error", contender).c_str(), "error", "m", "RMS, the largest at three times",
                     winner.trial->measured.error);
        table.number(fmt::format("{}_seconds", contender).c_str(), "time", "s/s", "wall seconds per simulated second", time);
      };
      show("ours", "ours", "the quickest at most as far off");
      show("implicit", "implicit", "the quickest implicit method at most as far off");
    }
  }
  return table.finish();
}

}  // namespace drape::bench
