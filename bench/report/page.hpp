#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/table.hpp"

namespace drape::bench {

/// One HTML page about some HDF5 files that needs nothing else, no network either: data, styles, scripts and the libraries for
/// plots (Plotly) and, if a run has a trajectory, for 3-D (three.js) are inside. `overview`: tables
/// that it begins with. Throws results::FileError.
std::string report_page(const std::vector<std::filesystem::path>& files, const std::vector<results::Table>& overview);

}  // namespace drape::bench
