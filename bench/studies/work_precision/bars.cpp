#include <fmt/format.h>

#include <optional>

#include "bench/studies/bar.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {
namespace {

using results::TableBuilder;

void add_bar(TableBuilder& table, const SceneTrials& scene, const std::string& name, const Bar& bar, double error,
             std::optional<double> value, const std::string& detail) {
  table.row();
  table.text("scene", "scene", "its name", scene.problem.name);
  table.text("bar", "bar", "what is compared", name);
  table.number("error", "error", "1", "at most", error);
  table.text("wanted", "wanted", "what is asked for", to_string(bar));
  table.text("detail", "", "what was compared", detail);
  if (!value) {
    table.text("verdict", "verdict", "whether the bar is met",
               bar.at_least ? "met: they do not reach it in time" : "NOT met: not reached");
    return;
  }
  table.number("value", "value", "1", "what was measured", *value);
  table.text("verdict", "verdict", "whether the bar is met", verdict(bar, *value));
}

/// Times that our defaults are quicker than SUNDIALS, tuned.
constexpr double wanted_lead = 1.5;

/// Hung by two corners, with Kelvin-Voigt damping as the thesis has it.
bool is_about_peers(const SceneTrials& scene) {
  return scene.problem.scene.name == "hung-corners" &&
         scene.problem.scene.sheet.material.damping_form != model::DampingForm::projected;
}

/// Both sides with hindsight, ours only with automatic stages and linear solvers.
void add_lead(TableBuilder& table, const SceneTrials& scene, const Winners& winners, double error) {
  const Winner peer = winners.of("sundials", error), mine = winners.of("defaults", error);
  const char* const name = "SUNDIALS tuned / any method, auto";
  const std::string detail = fmt::format("{} / {}", peer.name(), mine.name());
  if (peer && !mine)
    add_bar(table, scene, name, {wanted_lead, true}, error, 0.0, detail);
  else
    add_bar(table, scene, name, {wanted_lead, true}, error, peer ? std::optional(peer.time / mine.time) : std::nullopt, detail);
}

/// The search must be as thorough on their side as on ours.
void add_search_bar(TableBuilder& table, const SceneTrials& scene) {
  const int ours = number_of_families(scene, true), theirs = number_of_families(scene, false);
  add_bar(table, scene, "families of SUNDIALS / of ours", {1, true}, scene.problem.uncertainty, double(theirs) / ours,
          fmt::format("{} / {}", theirs, ours));
}

void add_bars(TableBuilder& table, const SceneTrials& scene, const std::string& usual) {
  const Winners winners(scene);
  for (const double error : levels(scene.problem)) {
    const Winner best = winners.of("ours", error);
    const auto ratio = [&](const Winner& a) { return a ? std::optional(a.time / best.time) : std::nullopt; };
    const auto names = [&](const Winner& a) { return fmt::format("{} / {}", a.name(), best.name()); };
    if (!best) {
      add_bar(table, scene, "our best", {1, false}, error, std::nullopt, "none");
      continue;
    }
    if (is_about_peers(scene)) add_lead(table, scene, winners, error);
    if (const Winner thesis = winners.of("thesis", error))
      add_bar(table, scene, "thesis' loop / our best", {3, true}, error, ratio(thesis), names(thesis));
    for (const std::string contender : {"defaults", usual.c_str()}) {
      const Winner winner = winners.of(contender, error);
      add_bar(table, scene, (contender == usual ? usual : "any method, auto") + " / our best", {default_bar, false}, error,
              ratio(winner), names(winner));
    }
  }
}

/// On peer-edge times are per simulated second and errors in metres.
void add_peer_bars(TableBuilder& table, const SceneTrials& scene) {
  const Winners winners(scene);
  const double end = scene.problem.times.back();
  const auto seconds = [&](const Winner& winner) { return winner ? std::optional(1e-3 * winner.time / end) : std::nullopt; };
  for (const PeerBar& bar : peer_bars) {
    const Winner best = winners.of(bar.contender, bar.error);
    add_bar(table, scene, fmt::format("{} [s per simulated second]", bar.contender), {bar.seconds, false}, bar.error,
            seconds(best), best.name());
  }
}

}  // namespace

results::Table bars_table(const std::vector<SceneTrials>& scenes) {
  TableBuilder table("bars", "What was asked for");
  const std::string usual = usual_choice(scenes);
  for (const SceneTrials& scene : scenes) {
    if (is_about_peers(scene)) add_search_bar(table, scene);
    if (!is_peer_edge(scene))
      add_bars(table, scene, usual);
    else if (scene.problem.scene.sheet.grid.nu == 100)
      add_peer_bars(table, scene);
  }
  return table.finish();
}

}  // namespace drape::bench
