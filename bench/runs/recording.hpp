#pragma once

#include <functional>
#include <string>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/sweep.hpp"
#include "results/file/run_file.hpp"

namespace drape::bench {

/// What a sweep does with the file it records in, unit by unit.
using Work = std::function<void(results::RunFile& file, Checkpoint& checkpoint)>;

/// Begins or continues the file that the options name, does the work, of `parts` pieces, and marks the file as finished. Does
/// nothing if it is finished already. `sweep`: identity of the work. Throws base::FileError, and Interrupted, naming the
/// file.
void record_in_file(const SweepOptions& options, const std::string& sweep, int parts, const Work& work);

}  // namespace drape::bench
