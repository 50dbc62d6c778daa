#include "bench/studies/stability/stability.hpp"

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

std::vector<TableJob> stability(bool quick, const Methods& methods) {
  std::vector<TableJob> jobs = stability_atlas(quick, methods);
  jobs.push_back(largest_steps(quick, methods));
  jobs.push_back(stress_cases(quick, methods));
  return jobs;
}

}  // namespace drape::bench
