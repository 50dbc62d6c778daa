#pragma once

#include <cstddef>

#include "bench/runs/run.hpp"

namespace drape::bench {

/// Wall time of a run by what it is spent on [ms]. Clocks are read around every call, which costs some 50 ns each.
struct Costs {
  double forces = 0;     ///< forces, their parts and derivatives
  double detection = 0;  ///< of contacts
  double rest = 0;       ///< linear systems, response to contacts, the method's own work

  double total() const { return forces + detection + rest; }
};

/// The costs of the first steps of a run of a scene with one phase, without compiling it.
Costs costs(const RunSpec& spec, std::size_t most_steps);

}  // namespace drape::bench
