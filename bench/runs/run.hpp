#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "bench/runs/limits.hpp"
#include "bench/runs/observer.hpp"
#include "bench/runs/run_spec.hpp"

namespace drape::bench {

/// How a run ended.
struct RunEnd {
  solver::RunResult result;
  solver::State state = {};                           ///< after the last accepted step; empty if there was no start
  std::int64_t evaluations = 0, newton_matrices = 0;  ///< of forces and Newton matrices in all; of the latter; 0 if not watched
  double cpu_ms = 0;                                  ///< processor time of the run with its observers

  bool succeeded() const { return result.outcome == solver::Outcome::success; }
};

/// Changes the equation of a phase before it is run, for example to time its functions.
using EquationHook = std::function<void(solver::SplitOde&)>;

/// The only place that makes an integrator of a scene, a method and options, and runs it. Observers see the start and every
/// accepted step, in their order. An exception of the method ends the run as `failed`; those of an observer pass, and
/// Interrupted. A run that exceeds its limits ends out of time, out of memory or out of evaluations; one that reaches its most
/// steps succeeds.
///
/// Runs without limits within steps are how runs are timed: nothing is counted, and interruptions wait for the end of a step.
RunEnd run(const RunSpec& spec, const model::Cloth& cloth, std::span<Observer* const> observers = {}, const Limits& limits = {},
           const EquationHook& hook = {});

/// The same, with the compilation of the scene under the limit of memory. `cloth` outlives what observers keep of it.
RunEnd run(const RunSpec& spec, std::optional<model::Cloth>& cloth, std::span<Observer* const> observers, const Limits& limits);

}  // namespace drape::bench
