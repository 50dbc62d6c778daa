#pragma once

#include <functional>
#include <vector>

#include "bench/runs/run.hpp"

namespace drape::bench {

/// Prepares a run outside of what is timed, and returns what is timed.
using Prepare = std::function<std::function<void()>()>;

/// Wall time, or CPU time of the whole process, which what else runs on the machine lengthens little.
enum class TimeOf { wall, process };

/// A run and how often it is repeated.
struct Repeated {
  Prepare prepare;
  int repetitions;
};

/// Times [ms] of runs, interleaved in random order by Google Benchmark. `done` is called after each repetition. Throws
/// Interrupted.
std::vector<std::vector<double>> time_runs(const std::vector<Repeated>& runs, const std::function<void()>& done,
                                           TimeOf time_of = TimeOf::wall);

/// The cell, to be timed as far as its run went.
Cell as_far_as(Cell cell, const results::RunRecord& run);

/// Wall times [ms] of the solver for every cell of a group: as time_runs() has them. Compiling the scene is outside,
/// building the matrix and all steps are inside, up to `most_steps` of the cell; energies are not evaluated. `steps`: how many
/// steps the last repetition of each cell took.
std::vector<std::vector<double>> time_group(const Group& group, int repetitions, const std::function<void()>& done,
                                            std::vector<std::size_t>* steps = nullptr);

}  // namespace drape::bench
