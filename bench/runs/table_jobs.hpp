#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/sweep.hpp"

namespace drape::bench {

/// A table to be computed in `parts` pieces of work; `compute` says what it does and calls checkpoint.advance() after each.
/// What takes seconds is a unit, which a process that was killed does not lose.
struct TableJob {
  int parts;
  std::function<results::Table(Checkpoint& checkpoint)> compute;
};

/// Computes all tables and returns them; after each it is in the file. Tables and units of work that a process before this one
/// has finished are not computed again. `identity`: of all that determines them. Progress on a terminal. Throws
/// base::FileError and Interrupted.
std::vector<results::Table> compute(const std::vector<TableJob>& jobs, const std::string& identity,
                                    const SweepOptions& options);

}  // namespace drape::bench
