#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/runs/limits.hpp"
#include "bench/runs/run_spec.hpp"
#include "results/provenance.hpp"
#include "results/run_record.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {

/// How a list of groups is run and recorded.
struct SweepOptions {
  int repetitions = 3;      ///< timed runs of every cell, besides the one that is recorded
  bool reference = true;    ///< whether errors are measured
  double agreement = 1e-7;  ///< largest disagreement of the families behind a reference, over the size of the scene
  Limits limits;            ///< of every cell; repetitions have none, and cells that exceeded them are not repeated
  std::filesystem::path out;
  results::Start start = results::Start::fresh;  ///< whether a file that is there is continued
  std::string command_line;
  std::optional<double> frames_every;                    ///< [s] between the frames of trajectories; none are kept without
  std::function<solver::Observer(const RunSpec&)> look;  ///< what sees the run of a cell that is recorded; may be empty
};

/// Runs all groups and returns all runs; after each group its runs are in the file. Groups and cells that a process before this
/// one has finished are not run again. Progress on a terminal; remarks on standard error. Throws reference::NotCertified, with
/// all earlier groups on disk, where two families disagree about a scene; Interrupted; base::FileError.
std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options);

/// A file in results/runs/ named after the time, the job and this process, in a folder made if need be. Throws FileError.
std::filesystem::path default_out(const std::string& job);

}  // namespace drape::bench
