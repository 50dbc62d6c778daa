#pragma once

#include <span>
#include <vector>

#include "results/run_record.hpp"
#include "results/table.hpp"

namespace drape::results {

/// One row per run. Users see the columns that matter most; in place of an error how and when a run failed, that positions
/// are not comparable, or, below ten times the reference's own error, that it is less than that.
Table to_table(std::span<const RunRecord> runs);

}  // namespace drape::results
