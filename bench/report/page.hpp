#pragma once

#include <span>
#include <string>
#include <vector>

#include "results/file/run_file.hpp"

namespace drape::bench {

/// One HTML page about some HDF5 files that needs nothing else, no network either: data, styles, scripts and the libraries for
/// plots (Plotly) and, if a run has a trajectory, for 3-D (three.js) are inside. `names`: of the files, as many as recordings.
/// `overview`: tables that it begins with.
std::string report_page(std::span<const std::string> names, std::span<const results::Recording> recordings,
                        std::span<const results::Table> overview);

}  // namespace drape::bench
