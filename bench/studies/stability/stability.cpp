#include "bench/studies/stability/stability.hpp"

#include "model/scene_file/scene_file.hpp"

namespace drape::bench {

Classification classify(solver::Outcome outcome, const UncertainError& measured, double bound) {
  switch (outcome) {
    case solver::Outcome::success: break;
    case solver::Outcome::unstable:
    case solver::Outcome::not_finite: return Classification::unstable;
    case solver::Outcome::not_converged:
    case solver::Outcome::breakdown:
    case solver::Outcome::failed:
    case solver::Outcome::inaccurate: return Classification::not_converged;
    case solver::Outcome::out_of_time:
    case solver::Outcome::out_of_memory:
    case solver::Outcome::out_of_evaluations: return Classification::not_finished;
  }
  if (measured.error + measured.uncertainty <= bound) return Classification::accurate;
  if (measured.error - measured.uncertainty > bound) return Classification::wrong;
  return Classification::bounded;
}

ClassifiedRun classified(RunEnd end, const CrossCheckedReference& reference) {
  ClassifiedRun run{std::move(end), {}, {}};
  run.error = reference.measure(run.end, error_bound);
  run.classification = classify(run.end.result.outcome, run.error, error_bound);
  return run;
}

CompiledScene hung_by_corners(int n, double k, double d) {
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
