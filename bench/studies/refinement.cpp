#include "bench/studies/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/record.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/analysis/order_fit.hpp"

namespace drape::bench {
namespace {

/// Runs one method with ever smaller steps.
class Refinement {
 public:
  Refinement(const RunSpec& cell, const std::string& name, const model::Cloth& cloth, const reference::Reference& reference)
      : cell_(cell), name_(name), cloth_(cloth), reference_(reference) {}

  void add_rows(results::TableBuilder& table, double most_work) {
    constexpr std::int64_t coarsest = 5, most = std::int64_t(1) << 22;
    const auto first = static_cast<double>(cell_.method->sub_steps ? std::max(coarsest, substeps(coarsest)) : coarsest);
    for (int k = 0;; ++k) {
      const std::int64_t n = std::llround(first * std::pow(refinement(), k));
      if (n > most) break;
      const results::RunRecord run = run_of(n);
      if (!add_row(table, run) || work(run) > most_work) break;
    }
    const auto fit = results::fit_order(steps_, errors_, uncertainty_);
    results::add_fit(table, fit, results::verdict(fit, cell_.method->order));
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
  bool add_row(results::TableBuilder& table, const results::RunRecord& run) {
    table.row();
    table.text("scene", "scene", "its name", cell_.scene.name);
    table.text("method", "method", "time integrator", name_);
    table.number("step", "h", "s", "step", run.step);
    if (run.outcome != solver::Outcome::success) {
      table.text("outcome", "outcome", "how the run failed", std::string(to_string(run.outcome)));
      if (run.outcome == solver::Outcome::failed) table.text("reason", "reason", "what was thrown", run.message);
      return true;
    }
    const results::ErrorRecord error = distance(run, reference_, cell_.scene, cloth_);
    uncertainty_ = error.reference_error;
    table.number("error", "rms error", "1", "distance from the reference at the end, over the size of the scene", error.rms);
    table.number("uncertainty", "", "1", "of the reference", error.reference_error);
    if (!errors_.empty())
      table.number("order", "order", "1", "between this step and the one before",
                   std::log(errors_.back() / error.rms) / std::log(steps_.back() / run.step));
    steps_.push_back(run.step);
    errors_.push_back(error.rms);
    return resolved(error);
  }

  const RunSpec& cell_;
  const std::string& name_;
  const model::Cloth& cloth_;
  const reference::Reference& reference_;
  std::vector<double> steps_, errors_;
  double uncertainty_ = 0;
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

void add_refinement(results::TableBuilder& table, const RunSpec& cell, const std::string& name, const model::Cloth& cloth,
                    const reference::Reference& reference, double most_work) {
  Refinement(cell, name, cloth, reference).add_rows(table, most_work);
}

}  // namespace drape::bench
