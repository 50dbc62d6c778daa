#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/sweep.hpp"
#include "results/file/run_file.hpp"

namespace drape::bench {

/// What a sweep records as a whole: a group of runs, or a table. `record` adds it to the file, unless it is there from a
/// process before this one, and advances the checkpoint `parts` times.
struct Job {
  int parts;
  std::function<void(results::RunFile& file, Checkpoint& checkpoint)> record;
};

/// Begins or continues the file that the options name, does the jobs one after the other, and marks the file as finished. Does
/// nothing if it is finished already. `sweep`: identity of the jobs. Throws base::FileError, and Interrupted, naming the file.
void record_in_file(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs);

}  // namespace drape::bench
