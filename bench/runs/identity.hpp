#pragma once

#include <string>

#include "bench/runs/sweep_options.hpp"

namespace drape::bench {

/// Identity of a run: a hash of all that determines its result beside the program itself and the machine, thus equal in all
/// files where the same was asked for: scene, method, solvers with their options, step, and whether errors are measured and the
/// motion is kept.
std::string identity(const RunSpec& spec, const SweepOptions& options);

/// Identity of a list of groups with their repetitions and limits.
std::string identity(const std::vector<Group>& groups, const SweepOptions& options);

}  // namespace drape::bench
