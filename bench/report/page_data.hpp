#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "results/file/run_file.hpp"

namespace drape::bench {

/// All that a report shows of one HDF5 file: its provenance, its tables, a table of its runs, and of each run its fields, steps
/// (at most 500 of them, evenly chosen), errors and trajectory, whose obstacles have the surfaces of a list that the runs
/// share. Numbers that are not finite are null (NaN) or the texts "inf" and "-inf", which JSON has no numbers for.
nlohmann::ordered_json page_data(const std::string& name, const results::Recording& recording);

/// A table of the page.
nlohmann::ordered_json page_table(const results::Table& table);

}  // namespace drape::bench
