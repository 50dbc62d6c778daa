#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drape::bench {

/// One HTML page about some HDF5 files that needs nothing else, no network either: data, styles, scripts and the libraries for
/// plots (Plotly) and, if a run has a trajectory, for 3-D (three.js) are inside. Throws results::FileError.
std::string report_page(const std::vector<std::filesystem::path>& files);

}  // namespace drape::bench
