#include <fmt/format.h>

#include <optional>

#include "bench/studies/target.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

using results::Datum;
using results::field;
using results::Role;
using results::Standing;

/// A bar about a scene, or about all that reaches an error on it.
struct BarRow {
  std::string scene, name;
  Target target;
  std::optional<double> error;
  std::optional<double> value;  ///< nothing: not reached
  std::string detail;

  results::Verdict verdict() const {
    if (value) return check(target, *value);
    return results::check(target.at_least, "they do not reach it in time", "not met: not reached");
  }
};

constexpr results::ColumnOf<BarRow> bar_row_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&BarRow::scene>},
    {"bar", "target", "", "what is compared", Role::key, field<&BarRow::name>},
    {"error", "error", "1", "at most", Role::key, field<&BarRow::error>},
    {"wanted", "target value", "", "bound of the value", Role::key,
     [](const BarRow& row) -> Datum { return to_string(row.target); }},
    {"detail", "", "", "what was compared", Role::note, field<&BarRow::detail>},
    {"value", "value", "1", "measured value", Role::time, field<&BarRow::value>},
    {"verdict", "verdict", "", "whether the target is met", Role::verdict,
     [](const BarRow& row) -> Datum { return row.verdict(); }},
};

using BarRows = std::vector<BarRow>;

/// Times that our defaults are quicker than SUNDIALS, tuned.
constexpr double wanted_lead = 1.5;

/// Both sides with hindsight, ours only with automatic stages and linear solvers.
void add_lead(BarRows& rows, const SceneRuns& scene, double error) {
  const Winner peer = winner(scene, &Configuration::is_sundials, error),
               mine = winner(scene, &Configuration::is_default, error);
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
void add_search_bar(BarRows& rows, const SceneRuns& scene) {
  const int ours = number_of_configurations(scene, true), theirs = number_of_configurations(scene, false);
  rows.push_back({scene.problem.name,
                  "families of SUNDIALS / of ours",
                  {1, true},
                  std::nullopt,
                  static_cast<double>(theirs) / ours,
                  fmt::format("{} / {}", theirs, ours)});
}

void add_bars(BarRows& rows, const SceneRuns& scene, const DefaultChoice& usual) {
  for (const double error : levels(scene.problem)) {
    const Winner best = winner(scene, &Configuration::is_ours, error);
    const auto ratio = [&](const Winner& a) { return a ? std::optional(a.time / best.time) : std::nullopt; };
    const auto names = [&](const Winner& a) { return fmt::format("{} / {}", a.name(), best.name()); };
    if (!best) {
      rows.push_back({scene.problem.name, "our best", {1, false}, error, std::nullopt, "none"});
      continue;
    }
    if (scene.problem.against_sundials) add_lead(rows, scene, error);
    if (const Winner thesis = winner(scene, &Configuration::is_thesis, error))
      rows.push_back({scene.problem.name, "thesis' loop / our best", {3, true}, error, ratio(thesis), names(thesis)});
    const auto add = [&](const std::string& name, const Contender& contender) {
      const Winner one = winner(scene, contender, error);
      rows.push_back({scene.problem.name, name + " / our best", {default_bar, false}, error, ratio(one), names(one)});
    };
    add("any method, auto", &Configuration::is_default);
    add("default " + usual.name(), usual);
  }
}

/// On peer-edge times are per simulated second and errors in metres.
void add_peer_bars(BarRows& rows, const SceneRuns& scene) {
  const double end = scene.problem.times.back();
  const auto seconds = [&](const Winner& one) { return one ? std::optional(1e-3 * one.time / end) : std::nullopt; };
  for (const PeerBar& bar : peer_bars) {
    const Winner best = winner(scene, bar.contender, bar.error);
    rows.push_back({scene.problem.name,
                    fmt::format("{} [s per simulated second]", bar.name),
                    {bar.seconds, false},
                    bar.error,
                    seconds(best),
                    best.name()});
  }
}

}  // namespace

results::Table bars_table(const std::vector<SceneRuns>& scenes) {
  BarRows rows;
  const DefaultChoice usual = usual_choice(scenes);
  for (const SceneRuns& scene : scenes) {
    if (scene.problem.against_sundials) add_search_bar(rows, scene);
    if (!scene.problem.in_metres)
      add_bars(rows, scene, usual);
    else if (scene.problem.scene.sheet.grid.nu == 100)
      add_peer_bars(rows, scene);
  }
  return results::make_table("bars", "Targets", bar_row_columns, rows);
}

}  // namespace drape::bench
