#include "results/analysis/scene_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/outcome.hpp"

namespace drape::results {
namespace {

/// Whether a contender in a table of work and precision is a solver of SUNDIALS.
bool is_sundials(std::string_view code) {
  return code.starts_with("cvode-") || code.starts_with("arkode-") || code.starts_with("ida-");
}

}  // namespace

RunsOfScene by_scene(std::span<const Recording> recordings) {
  RunsOfScene scenes;
  for (const Recording& recording : recordings)
    for (const RunRecord& run : recording.runs)
      scenes[run.overrides.empty() ? run.scene : fmt::format("{} {}", run.scene, run.overrides)].push_back(&run);
  return scenes;
}

bool ended_well(const RunRecord& run) { return run.outcome == solver::Outcome::success; }

Measured measured(const RunRecord& run) {
  if (!ended_well(run) || !run.error || !comparable(*run.error) || run.times_ms.empty()) return {NAN, {}};
  return {std::max(run.error->rms, resolution * run.error->reference_error), run.times_ms};
}

bool is_as_declared(std::string_view verdict) { return verdict.ends_with("as declared"); }

OrderCount count_orders(const Table& table) {
  const Column* verdicts = find_column(table, "verdict");
  OrderCount count;
  for (std::size_t row = 0; row < rows(table); ++row) {
    const std::string verdict = text_in(verdicts, row);
    count.curves += verdict.empty() ? 0 : 1;
    count.as_declared += is_as_declared(verdict) ? 1 : 0;
  }
  return count;
}

Peer quickest_peer(const Table& winners, std::size_t row) {
  constexpr std::string_view ending = "_ratio";
  Peer best;
  for (const Column& column : winners.columns) {
    const double ratio = number_in(&column, row);
    if (!is_sundials(column.name) || !column.name.ends_with(ending) || !std::isfinite(ratio) || ratio >= best.ratio) continue;
    const std::string family = column.name.substr(0, column.name.size() - ending.size());
    best = {text_in(find_column(winners, family), row), ratio};
  }
  return best;
}

}  // namespace drape::results
