#include "bench/studies/draping.hpp"

#include <fmt/format.h>

#include "solver/outcome.hpp"

namespace drape::bench {
namespace {

double sunk_corners(const model::Scene& scene, const results::RunRecord& run) {
  const model::Grid& grid = scene.sheet.grid;
  const solver::Vectors way = run.final_state.x - model::start(scene).x;
  double sunk = 0;
  for (const int b : {0, grid.nv - 1})
    for (const int a : {0, grid.nu - 1}) sunk += way.row(grid.index(a, b)).dot(scene.sheet.gravity.normalized()) / 4;
  return sunk;
}

}  // namespace

std::string ending(solver::Outcome outcome, double last_good_time) {
  return outcome == solver::Outcome::success ? "success" : fmt::format("{} at {:.4g} s", to_string(outcome), last_good_time);
}

Draping draping(const model::Scene& scene, const results::RunRecord& run, const std::optional<PublishedWork>& as_published) {
  return {work_count(run, "updates"),
          work_count(run, "cg_iterations"),
          sunk_corners(scene, run),
          run.steps.empty() ? 0 : run.steps.back().contacts,
          run.outcome,
          run.last_good_time,
          as_published};
}

}  // namespace drape::bench
