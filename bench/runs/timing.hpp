#pragma once

#include <functional>
#include <vector>

#include "bench/runs/run.hpp"
#include "results/run_record.hpp"

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

/// At most this number of steps of a run are timed, so that times and counters are of the same work.
std::size_t steps_to_time(const results::RunRecord& run);

/// Wall times [ms] of the solver for every run of a group, as time_runs() has them, each up to its most steps. Compiling the
/// scene is outside, building the matrix and all steps are inside; energies are not evaluated. `steps`: how many steps the last
/// repetition of each took.
std::vector<std::vector<double>> time_group(const Group& group, const std::vector<std::size_t>& most_steps, int repetitions,
                                            const std::function<void()>& done, std::vector<std::size_t>* steps = nullptr);

}  // namespace drape::bench
