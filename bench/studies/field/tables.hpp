#pragma once

#include "bench/studies/field/winners.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// All that was run, a table for each sheet, drawn as time against error; fronts, winners as a map over damping and error,
/// settings judged on other sheets, and the answer in short.
std::vector<results::Table> field_tables(const std::vector<SheetResult>& sheets);

/// Runs methods, or all, on sheets, and makes these tables.
Job field_job(std::vector<FieldSheet> list, const Methods& methods);

}  // namespace drape::bench
