#pragma once

#include "bench/runs/run_spec.hpp"

namespace drape::bench {

/// The accuracies that may be asked for: largest errors of positions over a run, over the size of the scene.
inline constexpr double finest_accuracy = 1e-7, coarsest_accuracy = 0.1;

/// Sets the method of a run, its step and its solvers so that its error should be at most `accuracy`, in the shortest time that
/// the rule knows of, and says why in `choice`. Nothing is compiled or run. Where the rule does not know the scene, pilot runs
/// of the run itself are to find the step (`ErrorControl::global`).
///
/// Throws std::invalid_argument where no choice can keep to an accuracy: with contacts and in phases.
void choose_automatically(RunSpec& spec, double accuracy);

}  // namespace drape::bench
