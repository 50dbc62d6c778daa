#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/runs/limits.hpp"
#include "bench/runs/observer.hpp"
#include "bench/runs/run_spec.hpp"
#include "bench/runs/shard.hpp"
#include "results/provenance.hpp"

namespace drape::bench {

/// How jobs are run and recorded.
struct SweepOptions {
  int repetitions = 3;      ///< timed runs of every spec, besides the one that is recorded
  bool reference = true;    ///< whether errors are measured
  double agreement = 1e-7;  ///< largest disagreement of the families behind a reference, over the size of the scene
  Limits limits;            ///< of every run; repetitions have none, and runs that exceeded them are not repeated
  std::filesystem::path out;
  results::Start start = results::Start::fresh;  ///< whether a file that is there is continued
  std::string command_line;
  std::optional<Share> shard;                 ///< of the sweep, which is all that is computed
  std::vector<std::filesystem::path> merged;  ///< journals of all its shards, from which it is recorded; empty: it is computed
  std::optional<double> frames_every;         ///< [s] between the frames of trajectories; none are kept without
  std::function<std::unique_ptr<Observer>(const RunSpec&)> observer_for;  ///< of runs that are recorded; may be empty
};

}  // namespace drape::bench
