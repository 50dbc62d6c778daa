#include <algorithm>
#include <iterator>
#include <optional>

#include "bench/studies/work_precision/winners.hpp"
#include "results/columns.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;

/// What other codes reach on peer-edge with 100 x 100 particles [m, s per simulated second].
struct OtherCode {
  const char* code;
  double error, seconds;
};
constexpr OtherCode other_codes[] = {{"Bullet, softbody", 0.53, 0.76},
                                     {"Bullet, deformable cloth, implicit", 0.053, 21.7},
                                     {"Bullet, deformable cloth, explicit", 2e-4, 29},
                                     {"XPBD, 20 sub-steps", 0.049, 2.1},
                                     {"XPBD, 100 sub-steps", 4e-3, 10.4},
                                     {"projective dynamics, 10 iterations", 0.098, 2.9},
                                     {"STARK (Newton, implicit Euler)", 0.051, 18.3},
                                     {"ARCSim", 0.072, 29},
                                     {"a plain vectorised leapfrog", 1.2e-4, 0.59}};

/// A quickest run of ours.
struct Match {
  Winner winner;
  double seconds;  ///< CPU time per simulated second
};

/// What another code reaches, and who of ours is at most as far off.
struct OtherCodeRow {
  int n;
  OtherCode other;
  std::optional<Match> ours, implicit;
};

constexpr ColumnOf<OtherCodeRow> other_code_columns[] = {
    {"n", "n", "1", "particles a side", Role::key, field<&OtherCodeRow::n>},
    {"code", "other code, 100 x 100", "", "measured elsewhere", Role::key,
     [](const OtherCodeRow& row) -> Datum { return row.other.code; }},
    {"their_error", "error", "m", "RMS at 0.5 s", Role::key, [](const OtherCodeRow& row) -> Datum { return row.other.error; }},
    {"their_seconds", "time", "s/s", "CPU seconds per simulated second", Role::time,
     [](const OtherCodeRow& row) { return row.n == 100 ? Datum(row.other.seconds) : Datum(); }},
};

constexpr ColumnOf<Match> match_columns[] = {
    {"{}", "{}", "", "{}", Role::note, [](const Match& match) -> Datum { return match.winner.name(); }},
    {"{}_error", "error", "m", "RMS, the largest at all tenths of the end", Role::note,
     [](const Match& match) -> Datum { return match.winner.run->measured.error; }},
    {"{}_seconds", "time", "s/s", "CPU seconds per simulated second", Role::time, field<&Match::seconds>},
};

std::vector<OtherCodeRow> other_code_rows(const SceneRuns& scene) {
  const auto match = [&](const Contender& contender, double error) {
    const Winner best = winner(scene, contender, error);
    return best ? std::optional(Match{best, 1e-3 * best.time / scene.problem.times.back()}) : std::nullopt;
  };
  std::vector<OtherCodeRow> rows;
  for (const OtherCode& other : other_codes)
    rows.push_back({scene.problem.scene.sheet.grid.nu, other, match(&Configuration::is_ours, other.error),
                    match(&Configuration::is_implicit, other.error)});
  return rows;
}

}  // namespace

std::vector<double> peer_errors() {
  std::vector<double> errors;
  for (const PeerBar& bar : peer_bars) errors.push_back(bar.error);
  for (const OtherCode& other : other_codes) errors.push_back(other.error);
  return errors;
}

results::Table peers_table(const std::vector<SceneRuns>& scenes) {
  std::vector<OtherCodeRow> rows;
  for (const SceneRuns& scene : scenes)
    if (scene.problem.with_other_codes) std::ranges::move(other_code_rows(scene), std::back_inserter(rows));
  results::Table table = results::make_table(
      "peer-edge", "Other codes on their own machine, and what is the quickest of ours with errors at most theirs on this one",
      other_code_columns, rows);
  results::add_columns(table, match_columns, rows, [](const OtherCodeRow& row) { return row.ours; },
                       {"ours", "ours", "the quickest at most as far off"});
  results::add_columns(table, match_columns, rows, [](const OtherCodeRow& row) { return row.implicit; },
                       {"implicit", "implicit", "the quickest implicit method at most as far off"});
  return table;
}

}  // namespace drape::bench
