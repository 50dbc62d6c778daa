#include "bench/studies/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

/// Runs one method with ever smaller steps.
class Refinement {
 public:
  Refinement(const RunSpec& cell, const std::string& name, const model::Cloth& cloth, const reference::Reference& reference)
      : cell_(cell), name_(name), cloth_(cloth), reference_(reference) {}

  std::vector<RefinedRun> runs(double most_work) {
    constexpr std::int64_t coarsest = 5, most = std::int64_t(1) << 22;
    const auto first = static_cast<double>(cell_.method->sub_steps ? std::max(coarsest, substeps(coarsest)) : coarsest);
    std::vector<RefinedRun> all;
    for (int k = 0;; ++k) {
      const std::int64_t n = std::llround(first * std::pow(refinement(), k));
      if (n > most) break;
      const results::RunRecord run = run_of(n);
      if (!add(all, run) || work(run) > most_work) break;
    }
    return all;
  }

 private:
  /// Halved steps take errors of order 4 and 5 through all digits in a few refinements.
  double refinement() const { return cell_.method->order > 3 ? std::numbers::sqrt2 : 2; }

  results::RunRecord run_of(std::int64_t steps) const {
    RunSpec cell = cell_;
    cell.step = cell.scene.end / static_cast<double>(steps);
    return record(cell);
  }

  /// Some methods divide longer steps: their coarsest is the stability limit.
  std::int64_t substeps(std::int64_t n) const { return results::work_count(run_of(n), "substeps"); }

  /// Evaluations of forces, which every method needs, or steps, a particle each.
  static double work(const results::RunRecord& run) {
    const std::int64_t count = std::max(results::work_count(run, "forces") + results::work_count(run, "explicit_forces"),
                                        results::work_count(run, "steps"));
    return static_cast<double>(count) * static_cast<double>(run.final_state.x.rows());
  }

  /// False where it makes no sense to go on.
  bool add(std::vector<RefinedRun>& runs, const results::RunRecord& run) {
    RefinedRun& refined = runs.emplace_back(RefinedRun{cell_.scene.name, name_, run.step, run.outcome});
    if (run.outcome == solver::Outcome::failed) refined.reason = run.message;
    if (!run.succeeded()) return true;
    const results::ErrorRecord error = distance(run, reference_, cell_.scene, cloth_);
    refined.error = error.rms;
    refined.uncertainty = error.reference_error;
    if (last_error_) refined.order = base::exponent(last_step_, *last_error_, run.step, error.rms);
    last_error_ = error.rms;
    last_step_ = run.step;
    return resolved(error);
  }

  const RunSpec& cell_;
  const std::string& name_;
  const model::Cloth& cloth_;
  const reference::Reference& reference_;
  std::optional<double> last_error_;
  double last_step_ = 0;
};

constexpr results::ColumnOf<RefinedRun> refined_columns[] = {
    {"scene", "scene", "", "its name", results::Role::key, results::field<&RefinedRun::scene>},
    {"method", "method", "", "time integrator", results::Role::key, results::field<&RefinedRun::method>},
    {"step", "h", "s", "time step", results::Role::key, results::field<&RefinedRun::step>},
    {"error", "rms error", "1", "distance from the reference at the end, over the size of the scene", results::Role::error,
     results::field<&RefinedRun::error>},
    {"uncertainty", "", "1", "of the reference", results::Role::uncertainty, results::field<&RefinedRun::uncertainty>},
    {"order", "order", "1", "between this step and the one before", results::Role::note, results::field<&RefinedRun::order>},
    {"outcome", "outcome", "", "how the run failed", results::Role::note,
     [](const RefinedRun& run) {
       return run.outcome == solver::Outcome::success ? results::Cell() : results::to_cell(run.outcome);
     }},
    {"reason", "reason", "", "what was thrown", results::Role::note, results::field<&RefinedRun::reason>},
};

}  // namespace

model::Scene smooth_scene() {
  return model::load_scene("hung-corners", std::vector<model::Override>{{"name", "soft"},
                                                                        {"grid.n", "5"},
                                                                        {"material.tension", "20"},
                                                                        {"material.damping", "2"},
                                                                        {"material.shear", "0.2"},
                                                                        {"end.time", "0.6"}});
}

RunSpec tight(const model::Scene& scene, const std::string& name) {
  RunSpec cell{scene, "", nullptr, scene.end, solver::thesis_options()};
  cell.options.loop_tolerance = 1e-11;
  cell.options.cg_tolerance = 1e-12;
  cell.options.stage_accuracy = 1e-4;
  cell.options.linear_solver = &solver::linear_solver("cholesky");
  choose_method(cell, name);
  return cell;
}

std::vector<RefinedRun> refine(const RunSpec& cell, const std::string& name, const model::Cloth& cloth,
                               const reference::Reference& reference, double most_work) {
  return Refinement(cell, name, cloth, reference).runs(most_work);
}

void fit_curve(std::vector<RefinedRun>& runs, int declared_order) {
  std::vector<double> steps, errors;
  double uncertainty = 0;
  for (const RefinedRun& run : runs)
    if (run.error) {
      steps.push_back(run.step);
      errors.push_back(*run.error);
      uncertainty = *run.uncertainty;
    }
  const auto fit = results::fit_order(steps, errors, uncertainty);
  runs.front().curve = {fit, results::order_verdict(fit, declared_order)};
}

results::Table refinement_table(std::string name, std::string description, const std::vector<RefinedRun>& runs) {
  results::Table table = results::make_table(std::move(name), std::move(description), refined_columns, runs);
  results::add_columns(table, results::fit_columns, runs, std::mem_fn(&RefinedRun::curve));
  using results::Part;
  draw(table, results::Figure::convergence,
       {{Part::figure, "scene"}, {Part::curve, "method"}, {Part::x, "step"}, {Part::y, "error"}, {Part::detail, "order"}});
  return table;
}

}  // namespace drape::bench
