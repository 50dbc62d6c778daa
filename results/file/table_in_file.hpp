#pragma once

#include <string>
#include <vector>

#include "results/file/hdf5.hpp"
#include "results/table.hpp"

namespace drape::results {

/// Writes a table as a group of datasets, one for each column; what users are shown in place of cells is not kept.
void write_table(const hdf5::Handle& tables, const Table& table);

/// The columns of a table in their order. `version`: of the file's schema.
std::vector<std::string> column_names(const hdf5::Handle& group, int version);

Table read_table(const hdf5::Handle& tables, const std::string& name, int version);

}  // namespace drape::results
