#pragma once

#include <functional>
#include <vector>

#include "bench/cell.hpp"

namespace drape::bench {

/// Wall times [ms] of the solver for every cell of a group: `repetitions` each, interleaved in random order by Google
/// Benchmark. Compiling the scene is outside, building the matrix and all steps are inside. `done` is called after each.
std::vector<std::vector<double>> time_group(const Group& group, int repetitions, const std::function<void()>& done);

}  // namespace drape::bench
