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

std::vector<Job> stability(const Question& question) {
  const auto& [quick, methods, scene] = question;
  return {stability_atlas(quick, methods), largest_steps(quick, methods), stress_cases(quick, methods)};
}

}  // namespace drape::bench
