#pragma once

#include <string>
#include <vector>

#include "bench/studies.hpp"
#include "bench/sweep.hpp"

namespace drape::bench {

/// Computes all tables and returns them; after each it is in the file. Tables and units of work that a process before this one
/// has finished are not computed again. `identity`: of all that determines them. Progress on a terminal. Throws
/// results::FileError and Interrupted.
std::vector<results::Table> compute(const std::vector<TableJob>& jobs, const std::string& identity,
                                    const SweepOptions& options);

}  // namespace drape::bench
