#include "results/analysis/scene_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drape::results {

RunsOfScene by_scene(std::span<const Recording> recordings) {
  RunsOfScene scenes;
  for (const Recording& recording : recordings)
    for (const RunRecord& run : recording.runs)
      scenes[run.overrides.empty() ? run.scene : fmt::format("{} {}", run.scene, run.overrides)].push_back(&run);
  return scenes;
}

Measured measured(const RunRecord& run) {
  if (!run.succeeded() || !run.error || !comparable(*run.error) || run.times_ms.empty()) return {NAN, {}};
  return {std::max(run.error->rms, resolution * run.error->reference_error), run.times_ms};
}

OrderCount count_orders(const Table& table) {
  const Column* verdicts = find_column(table, Role::verdict);
  OrderCount count;
  for (std::size_t row = 0; row < rows(table); ++row) {
    count.curves += text_in(verdicts, row).empty() ? 0 : 1;
    count.as_declared += verdicts != nullptr && standing(verdicts->cells[row]) == Standing::met ? 1 : 0;
  }
  return count;
}

}  // namespace drape::results
