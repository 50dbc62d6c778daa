#pragma once

#include "bench/runs/run.hpp"
#include "reference/reference.hpp"
#include "results/table_builder.hpp"

namespace drape::bench {

/// A sheet so soft and damped that its motion is smooth at large steps: errors of all methods, of order 5 too, fall as declared
/// before they are as small as the reference's.
model::Scene smooth_scene();

/// A way to solve a scene, so tight that what is left of the error is the method's own. `name`: of the method, with stage and
/// linear solvers or without. Throws std::invalid_argument as choose_method() does.
RunSpec tight(const model::Scene& scene, const std::string& name);

/// Runs a cell with ever smaller steps, until its error is as small as the reference's, or a run takes too much work:
/// evaluations of forces times particles, counted, so that the curve ends at the same step on every machine. Adds a row for
/// each run, and to the last the order with its verdict.
void add_refinement(results::TableBuilder& table, const RunSpec& cell, const std::string& name, const model::Cloth& cloth,
                    const reference::Reference& reference, double most_work);

}  // namespace drape::bench
