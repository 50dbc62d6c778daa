#include "bench/studies/stability/stability.hpp"

#include <cmath>

#include "model/scene_file/scene_file.hpp"

namespace drape::bench {

Judged judged(RunEnd trial, const CrossCheckedReference& reference) {
  Judged result{std::move(trial), {}, {}};
  result.error = reference.measure(result.trial, error_bound);
  result.verdict = judge(result.trial.result.outcome, result.error, error_bound);
  return result;
}

Specimen hung_by_corners(int n, double k, double d) {
  model::Scene scene = model::load_scene("hung-corners");
  scene.sheet.grid.nu = scene.sheet.grid.nv = n;
  scene.sheet.material.tension = {k, k};
  scene.sheet.material.damping = {d, d};
  scene.sheet.material.shear = k / 100;
  scene.end = horizon;
  return {scene, model::compile(scene)};
}

void add_verdict(results::TableBuilder& table, const Judged& judged, bool shown) {
  const auto title = [shown](const char* text) { return shown ? text : ""; };
  table.text("verdict", title("verdict"), "what became of the run", std::string(to_string(judged.verdict)));
  if (!std::isnan(judged.error.error)) {
    table.number("error", title("error"), "1", "of the end over the size, positions or centre of mass; none: not known",
                 judged.error.error);
    table.number("uncertainty", title("±"), "1", "of the error: how far two reference methods differ",
                 judged.error.uncertainty);
  }
  table.count("steps", title("steps"), "accepted ones", judged.trial.result.steps);
  table.count("rejected", title("rejected"), "steps that were cut", judged.trial.result.rejected_steps);
  table.count("evaluations", title("evaluations"), "of forces, and of Newton matrices", judged.trial.evaluations);
  table.count("newton_matrices", title("Newton"), "matrices made", judged.trial.newton_matrices);
  table.number("cpu_ms", "", "ms", "processor time", judged.trial.cpu_ms);
  table.text("reason", title("reason"), "why it did not succeed", reason(judged.trial));
}

std::vector<TableJob> stability(bool quick, const Methods& methods) {
  std::vector<TableJob> jobs = stability_atlas(quick, methods);
  jobs.push_back(largest_steps(quick, methods));
  jobs.push_back(stress_cases(quick, methods));
  return jobs;
}

}  // namespace drape::bench
