#pragma once

#include "results/file/hdf5.hpp"
#include "results/run_record.hpp"

namespace drape::results {

/// Writes a trajectory as the group `trajectory` of a run.
void write_trajectory(const hdf5::Handle& run, const TrajectoryRecord& trajectory);

/// Throws hdf5::Error if a dataset is missing or has not as many numbers as frames and particles make.
TrajectoryRecord read_trajectory(const hdf5::Handle& run);

}  // namespace drape::results
