#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "results/run_record.hpp"

namespace drape::results {

/// Where write_xdmf() puts its text: `runs.h5.xdmf` beside `runs.h5`.
std::filesystem::path xdmf_path(const std::filesystem::path& hdf5_file);

/// The trajectories of a file's runs, all of them in their order, as XDMF that ParaView opens by its "Xdmf3 Reader": for each
/// run a series of structured grids with velocity, stretch and constraint, whose numbers stay in the HDF5 file beside it.
/// Replaces what was there; throws FileError if it cannot be written.
void write_xdmf(const std::filesystem::path& hdf5_file, std::span<const RunRecord> runs);

}  // namespace drape::results
