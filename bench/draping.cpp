#include "bench/draping.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace drape::bench {

Draping drape_once(const Cell& cell) {
  const model::Grid& grid = cell.scene.sheet.grid;
  const Eigen::Vector3d down = cell.scene.sheet.gravity.normalized();
  Draping draping;
  std::optional<solver::Vectors> start;
  draping.run = record(cell, [&](const solver::StepReport& step) {
    if (!start) start = step.y.x;
    draping.constrained = step.contacts.constrained;
  });
  const solver::Vectors way = draping.run.final_state.x - *start;
  for (const int b : {0, grid.nv - 1})
    for (const int a : {0, grid.nu - 1}) draping.drop += way.row(grid.index(a, b)).dot(down) / 4;
  return draping;
}

void add_draping(results::TableBuilder& table, const Draping& draping, std::optional<double> solver_ms,
                 const std::optional<Printed>& thesis) {
  const results::RunRecord& run = draping.run;
  table.count("updates", "updates", "of the fixed-point loop; one a step in IMEX methods", work_count(run, "updates"));
  table.count("cg_iterations", "CG", "iterations of conjugate gradients", work_count(run, "cg_iterations"));
  if (solver_ms) table.number("solver_ms", "solver", "ms", "wall time of the solver, median of interleaved runs", *solver_ms);
  if (thesis) {
    table.count("thesis_updates", "thesis: updates", "printed in the thesis", thesis->updates);
    table.count("thesis_cg_iterations", "thesis: CG", "printed in the thesis", thesis->cg_iterations);
  }
  table.number("drop", "corners sink", "m", "mean of the four corners from start to end", draping.drop);
  table.count("constrained", "in contact", "particles that touched something in the last step", draping.constrained);
  const bool succeeded = run.outcome == to_string(solver::Outcome::success);
  table.text("outcome", "outcome", "how the run ended",
             succeeded ? run.outcome : fmt::format("{} at {:.4g} s", run.outcome, run.last_good_time));
}

double median(std::vector<double> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::ranges::nth_element(numbers, middle);
  if (numbers.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(numbers.begin(), middle)) / 2;
}

}  // namespace drape::bench
