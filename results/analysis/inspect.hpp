#pragma once

#include <vector>

#include "results/provenance.hpp"
#include "results/run_record.hpp"
#include "results/table.hpp"

namespace drape::results {

/// Where results come from, as a table: name and value.
Table to_table(const Provenance& facts);

/// Tables by name, with their rows and descriptions.
Table list_of(const std::vector<Table>& tables);

/// All of one run in tables: what it was, its scene key by key, parameters, work, errors and contact where there are any, and
/// of every series of numbers its range.
std::vector<Table> in_full(const RunRecord& run);

}  // namespace drape::results
