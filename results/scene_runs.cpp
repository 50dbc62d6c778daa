#include "results/scene_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/outcome.hpp"

namespace drape::results {

RunsOfScene by_scene(std::span<const Recording> recordings) {
  RunsOfScene scenes;
  for (const Recording& recording : recordings)
    for (const RunRecord& run : recording.runs)
      scenes[run.overrides.empty() ? run.scene : fmt::format("{} {}", run.scene, run.overrides)].push_back(&run);
  return scenes;
}

bool ended_well(const RunRecord& run) { return run.outcome == to_string(solver::Outcome::success); }

Measured measured(const RunRecord& run) {
  if (!ended_well(run) || !run.error || !comparable(*run.error) || run.times_ms.empty()) return {NAN, {}};
  return {std::max(run.error->rms, resolution * run.error->reference_error), run.times_ms};
}

bool is_sundials(std::string_view code) {
  return code.starts_with("cvode-") || code.starts_with("arkode-") || code.starts_with("ida-");
}

}  // namespace drape::results
