#pragma once

#include <cstddef>
#include <vector>

#include "bench/runs/run.hpp"

namespace drape::bench {

/// Wall time of a run by what it is spent on [ms]. Clocks are read around every call, which costs some 50 ns each.
struct Costs {
  double forces = 0;     ///< forces, their parts and derivatives
  double detection = 0;  ///< of contacts
  double response = 0;   ///< to contacts: which constraints hold, friction; the systems with them are of `rest`
  double rest = 0;       ///< linear systems, the method's own work, compiling of phases after the first

  double total() const { return forces + detection + response + rest; }
};

/// The costs of the first steps of a run, without compiling the scene.
Costs costs(const RunSpec& spec, std::size_t most_steps);

/// Costs a simulated second [ms/s]: medians of interleaved repetitions.
struct MedianCosts {
  Costs median;
  double spread = 0;  ///< half the range of the total
};

/// Those of the first steps of each run of a group. `steps`: how many, more than 0.
std::vector<MedianCosts> median_costs(const Group& group, const std::vector<std::size_t>& steps, int repetitions);

}  // namespace drape::bench
