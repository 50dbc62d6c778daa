#pragma once

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "solver/outcome.hpp"
#include "solver/split_ode.hpp"

namespace drape::bench {

/// What a run may use.
struct Limits {
  double seconds = std::numeric_limits<double>::infinity();    ///< wall time
  double megabytes = std::numeric_limits<double>::infinity();  ///< of memory beside what the process holds already
  /// Forces and Newton matrices: a limit that does not depend on the machine.
  std::int64_t evaluations = std::numeric_limits<std::int64_t>::max();
  std::size_t steps = std::numeric_limits<std::size_t>::max();  ///< accepted ones, after which the run ends as it stands
  bool interruptible_steps = false;  ///< whether an interruption ends a step, and not only the run after it

  /// Whether evaluations must be watched: what is timed has none of these.
  bool within_steps() const {
    return interruptible_steps || std::isfinite(seconds) || evaluations < std::numeric_limits<std::int64_t>::max();
  }
};

/// A limit of time or evaluations was reached.
struct LimitReached : std::runtime_error {
  LimitReached(solver::Outcome kind, const std::string& message) : std::runtime_error(message), outcome(kind) {}
  solver::Outcome outcome;  ///< out_of_time or out_of_evaluations
};

/// Counts the evaluations of an equation and ends what exceeds its limits, also within a step.
class Meter {
 public:
  explicit Meter(const Limits& limits);

  /// From now on evaluations of the forces of `ode` and their derivatives are counted here, and throw LimitReached when a limit
  /// is exceeded and Interrupted when the sweep is to end. The meter must outlive them.
  void watch(solver::SplitOde& ode);

  /// The limit that was exceeded, if one was: solvers of SUNDIALS make LimitReached an error of theirs.
  const std::optional<LimitReached>& reached() const { return reached_; }

  std::int64_t evaluations() const { return evaluations_; }  ///< of forces and Newton matrices
  std::int64_t newton_matrices() const { return newton_matrices_; }

 private:
  void check();
  void count();
  [[noreturn]] void end(solver::Outcome outcome, const std::string& message);

  const Limits limits_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::int64_t evaluations_ = 0, newton_matrices_ = 0;
  std::optional<LimitReached> reached_;
};

/// As long as it lives the process may take this much more memory; beyond that operator new throws std::bad_alloc.
class MemoryLimit {
 public:
  explicit MemoryLimit(double megabytes);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_;
};

}  // namespace drape::bench
