#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/runs/limits.hpp"
#include "model/cloth.hpp"
#include "results/run_record.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {

/// One run: a scene, a method, a step. `scene.end` is the time it runs to.
struct Cell {
  model::Scene scene;
  std::string overrides;  ///< for people: what differs from the scene's file
  const solver::Method* method;
  double step;  ///< [s]
  solver::Options options;
  std::size_t most_steps = std::numeric_limits<std::size_t>::max();  ///< after which a timed repetition ends

  /// The method with its stage and linear solvers where they are not the usual ones: "bdf2", "bdf2/fixed-point/ic0".
  std::string method_name() const;
};

/// Sets method, stage and linear solver from a name like that. Throws std::invalid_argument with all that there is to choose
/// from.
void choose_method(Cell& cell, const std::string& name);

/// Cells that are compared with each other: repetitions are interleaved within a group and it is recorded as a whole.
using Group = std::vector<Cell>;

/// Outcomes of runs that exceed their limits.
inline constexpr const char* out_of_time = "out of time";
inline constexpr const char* out_of_memory = "out of memory";

/// Runs a cell once and records everything but times and errors. `look` sees the start and every accepted step. `frames_every`:
/// the motion is kept too, in frames so many simulated seconds apart. A run that exceeds the limits ends there, out of time or
/// out of memory, with what it has reached. Throws Interrupted.
results::RunRecord record(const Cell& cell, const solver::Observer& look = {}, std::optional<double> frames_every = {},
                          const Limits& limits = {});

}  // namespace drape::bench
