#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/cell.hpp"

namespace drape::bench {

/// How a list of groups is run and recorded.
struct SweepOptions {
  int repetitions = 3;      ///< timed runs of every cell, besides the one that is recorded
  bool reference = true;    ///< whether errors are measured
  double agreement = 1e-7;  ///< largest disagreement of the families behind a reference, over the size of the scene
  std::filesystem::path out;
  std::string command_line;
  std::optional<double> frames_every;                 ///< [s] between the frames of trajectories; none are kept without
  std::function<solver::Observer(const Cell&)> look;  ///< what sees the run of a cell that is recorded; may be empty
};

/// Runs all groups; after each its runs are on disk. Progress on a terminal; remarks on standard error. Throws
/// reference::NotCertified, with all earlier groups on disk, where two families disagree about a scene.
std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options);

/// A file in results/runs/ named after the time, the job and this process, in a folder made if need be. Throws FileError.
std::filesystem::path default_out(const std::string& job);

}  // namespace drape::bench
