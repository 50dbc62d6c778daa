#pragma once

#include <span>
#include <vector>

#include "results/run_record.hpp"
#include "results/table.hpp"

namespace drape::results {

/// One row per run. People see the columns that matter most; in place of an error how and when a run failed, that positions
/// are not comparable, or, below ten times the reference's own error, that it is less than that.
Table to_table(std::span<const RunRecord> runs);

/// The number below which a share of the numbers is: 0 least, 0.5 median, 1 largest; interpolated between two. At least one.
double quantile(std::vector<double> numbers, double share);

}  // namespace drape::results
