#pragma once

#include <sys/resource.h>

#include <limits>
#include <stdexcept>

#include "solver/split_ode.hpp"

namespace drape::bench {

/// What a cell may use.
struct Limits {
  double seconds = std::numeric_limits<double>::infinity();    ///< wall time
  double megabytes = std::numeric_limits<double>::infinity();  ///< of memory beside what the process holds already
};

struct OutOfTime : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// From now on evaluations of forces and their derivatives throw OutOfTime when so much time is over, and Interrupted when the
/// sweep is to end: so a loop within a step ends, too.
void watch(solver::SplitOde& ode, double seconds);

/// As long as it lives the process may take so much more memory; beyond that operator new throws std::bad_alloc.
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
