#include "bench/studies/draping.hpp"

#include <fmt/format.h>

#include "results/analysis/runs_table.hpp"
#include "solver/base/statistics.hpp"
#include "solver/outcome.hpp"

namespace drape::bench {
namespace {

/// By which the four corners have sunk, their mean [m].
double sunk_corners(const model::Scene& scene, const results::RunRecord& run) {
  const model::Grid& grid = scene.sheet.grid;
  const solver::Vectors way = run.final_state.x - model::start(scene).x;
  double sunk = 0;
  for (const int b : {0, grid.nv - 1})
    for (const int a : {0, grid.nu - 1}) sunk += way.row(grid.index(a, b)).dot(scene.sheet.gravity.normalized()) / 4;
  return sunk;
}

}  // namespace

void add_draping(results::TableBuilder& table, const model::Scene& scene, const results::RunRecord& run,
                 const std::optional<Printed>& thesis) {
  table.count("updates", "updates", "of the fixed-point loop; of IMEX methods one a step, more in contact",
              work_count(run, "updates"));
  table.count("cg_iterations", "CG", "iterations of conjugate gradients", work_count(run, "cg_iterations"));
  if (!run.times_ms.empty())
    table.number("solver_ms", "solver", "ms", "wall time of the solver, median of interleaved runs",
                 base::quantile(run.times_ms, 0.5));
  table.number("sunk", "corners sink", "m", "mean of the four corners from start to end", sunk_corners(scene, run));
  table.count("contacts", "in contact", "particles that touched something in the last step",
              run.steps.empty() ? 0 : run.steps.back().contacts);
  const bool succeeded = run.outcome == solver::Outcome::success;
  table.text("outcome", "outcome", "how the run ended",
             succeeded ? "success" : fmt::format("{} at {:.4g} s", to_string(run.outcome), run.last_good_time));
  if (!thesis) return;
  table.count("thesis_updates", "thesis: updates", "printed in the thesis", thesis->updates);
  table.count("thesis_cg_iterations", "thesis: CG", "printed in the thesis", thesis->cg_iterations);
  if (thesis->seconds)
    table.number("thesis_seconds", "thesis: solver", "s", "printed in the thesis: Pentium III, 660 MHz", *thesis->seconds);
}

}  // namespace drape::bench
