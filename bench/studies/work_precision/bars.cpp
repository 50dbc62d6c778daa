#include <fmt/format.h>

#include <optional>

#include "bench/studies/bar.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::Cell;
using results::field;
using results::Role;
using results::Standing;

/// A bar about a scene, or about all that reaches an error on it.
struct BarRow {
  std::string scene, name;
  Bar bar;
  std::optional<double> error;
  std::optional<double> value;  ///< nothing: not reached
  std::string detail;

  results::Verdict verdict() const {
    if (value) return bench::verdict(bar, *value);
    return bar.at_least ? results::Verdict{Standing::met, "they do not reach it in time"}
                        : results::Verdict{Standing::missed, "not met: not reached"};
  }
};

constexpr results::ColumnOf<BarRow> bar_row_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&BarRow::scene>},
    {"bar", "target", "", "what is compared", Role::key, field<&BarRow::name>},
    {"error", "error", "1", "at most", Role::key, field<&BarRow::error>},
    {"wanted", "target value", "", "bound of the value", Role::key,
     [](const BarRow& row) -> Cell { return to_string(row.bar); }},
    {"detail", "", "", "what was compared", Role::note, field<&BarRow::detail>},
    {"value", "value", "1", "measured value", Role::time, field<&BarRow::value>},
    {"verdict", "verdict", "", "whether the target is met", Role::verdict,
     [](const BarRow& row) -> Cell { return row.verdict(); }},
};

using BarRows = std::vector<BarRow>;

/// Times that our defaults are quicker than SUNDIALS, tuned.
constexpr double wanted_lead = 1.5;

/// Hung by two corners, with Kelvin-Voigt damping as the thesis has it.
bool is_about_peers(const SceneTrials& scene) {
  return scene.problem.scene.name == "hung-corners" &&
         scene.problem.scene.sheet.material.damping_form != model::DampingForm::projected;
}

/// Both sides with hindsight, ours only with automatic stages and linear solvers.
void add_lead(BarRows& rows, const SceneTrials& scene, const Winners& winners, double error) {
  const Winner peer = winners.of("sundials", error), mine = winners.of("defaults", error);
  std::optional<double> lead;
  if (peer) lead = mine ? peer.time / mine.time : 0;
  rows.push_back({scene.problem.name,
                  "SUNDIALS tuned / any method, auto",
                  {wanted_lead, true},
                  error,
                  lead,
                  fmt::format("{} / {}", peer.name(), mine.name())});
}

/// The search must be as thorough on their side as on ours.
void add_search_bar(BarRows& rows, const SceneTrials& scene) {
  const int ours = number_of_families(scene, true), theirs = number_of_families(scene, false);
  rows.push_back({scene.problem.name,
                  "families of SUNDIALS / of ours",
                  {1, true},
                  std::nullopt,
                  static_cast<double>(theirs) / ours,
                  fmt::format("{} / {}", theirs, ours)});
}

void add_bars(BarRows& rows, const SceneTrials& scene, const std::string& usual) {
  const Winners winners(scene);
  for (const double error : levels(scene.problem)) {
    const Winner best = winners.of("ours", error);
    const auto ratio = [&](const Winner& a) { return a ? std::optional(a.time / best.time) : std::nullopt; };
    const auto names = [&](const Winner& a) { return fmt::format("{} / {}", a.name(), best.name()); };
    if (!best) {
      rows.push_back({scene.problem.name, "our best", {1, false}, error, std::nullopt, "none"});
      continue;
    }
    if (is_about_peers(scene)) add_lead(rows, scene, winners, error);
    if (const Winner thesis = winners.of("thesis", error))
      rows.push_back({scene.problem.name, "thesis' loop / our best", {3, true}, error, ratio(thesis), names(thesis)});
    for (const std::string contender : {"defaults", usual.c_str()}) {
      const Winner winner = winners.of(contender, error);
      rows.push_back({scene.problem.name,
                      (contender == usual ? usual : "any method, auto") + " / our best",
                      {default_bar, false},
                      error,
                      ratio(winner),
                      names(winner)});
    }
  }
}

/// On peer-edge times are per simulated second and errors in metres.
void add_peer_bars(BarRows& rows, const SceneTrials& scene) {
  const Winners winners(scene);
  const double end = scene.problem.times.back();
  const auto seconds = [&](const Winner& winner) { return winner ? std::optional(1e-3 * winner.time / end) : std::nullopt; };
  for (const PeerBar& bar : peer_bars) {
    const Winner best = winners.of(bar.contender, bar.error);
    rows.push_back({scene.problem.name,
                    fmt::format("{} [s per simulated second]", bar.contender),
                    {bar.seconds, false},
                    bar.error,
                    seconds(best),
                    best.name()});
  }
}

}  // namespace

results::Table bars_table(const std::vector<SceneTrials>& scenes) {
  BarRows rows;
  const std::string usual = usual_choice(scenes);
  for (const SceneTrials& scene : scenes) {
    if (is_about_peers(scene)) add_search_bar(rows, scene);
    if (!is_peer_edge(scene))
      add_bars(rows, scene, usual);
    else if (scene.problem.scene.sheet.grid.nu == 100)
      add_peer_bars(rows, scene);
  }
  return results::make_table("bars", "Targets", bar_row_columns, rows);
}

}  // namespace drape::bench
