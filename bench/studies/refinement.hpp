#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/recording.hpp"
#include "bench/runs/run.hpp"
#include "reference/reference.hpp"
#include "results/analysis/order_fit.hpp"

namespace drape::bench {

/// A sheet so soft and damped that its motion is smooth at large steps: errors of all methods, of order 5 too, fall as declared
/// before they are as small as the reference's.
model::Scene smooth_scene();

/// A way to solve a scene, so tight that what is left of the error is the method's own. `name`: of the method, with stage and
/// linear solvers or without. Throws std::invalid_argument as choose_method() does.
RunSpec tight(const model::Scene& scene, const std::string& name);

/// The same with the usual solvers of a method, which need not be one of the table.
RunSpec tight(const model::Scene& scene, const solver::Method& method);

/// A run of one method with one step.
struct RefinedRun {
  std::string scene, method;
  double step;  ///< [s]
  solver::Outcome outcome = solver::Outcome::success;
  std::optional<std::string> reason = {};  ///< what was thrown
  std::optional<double> error = {}, uncertainty = {}, order = {};
  std::optional<results::FittedCurve> curve = {};  ///< of all steps, with the first, which is the same everywhere
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RefinedRun, scene, method, step, outcome, reason, error, uncertainty, order)

/// Runs a spec with ever smaller steps, each a checkpoint, until its error is as small as the reference's, or a run takes too
/// much work: evaluations of forces times particles, counted, so that the curve ends at the same step on every machine.
std::vector<RefinedRun> refine(const RunSpec& spec, const std::string& name, const model::Cloth& cloth,
                               const reference::Reference& reference, double most_work, Checkpoint& checkpoint);

/// Gives the first run its curve.
void fit_curve(std::vector<RefinedRun>& runs, int declared_order);

/// The curves of methods on a scene, with its own reference: a job. most_work: as in `refine`.
Job orders_on(const model::Scene& scene, double most_work, const std::vector<const solver::Method*>& methods);

/// A table of such curves.
results::Table refinement_table(std::string name, std::string description, const std::vector<RefinedRun>& runs);

}  // namespace drape::bench
