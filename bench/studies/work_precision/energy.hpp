#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/runs/run.hpp"

/// Runs beside those that are timed, with the energy guard: a candidate whose energy no motion of the scene can have must not
/// win, however near its end is to the truth.
namespace drape::bench {

/// Why the energy guard ends a run of ours; empty if it does not.
std::string energy_fault(const RunSpec& spec);

/// The states of a compiled scene at some times.
using States = std::function<std::vector<solver::State>(const model::Cloth& cloth, std::span<const double> times)>;

/// The same for a run of another code, seen at times that divide the run into equal parts.
std::string energy_fault(const model::Scene& scene, const States& solve, int parts);

}  // namespace drape::bench
