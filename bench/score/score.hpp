#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/runs/recording.hpp"
#include "bench/score/external_motion.hpp"

namespace drape::bench {

/// What an external motion is measured by.
struct ScoreOptions {
  std::optional<double> cost;        ///< what it took on this machine [s]
  std::vector<std::string> methods;  ///< of ours, to stand beside it
  double agreement;                  ///< as References has it
  int repetitions;                   ///< of those of ours that are timed
};

/// Records the tables `score` (over time), `score-summary`, `score-ours` and, for files, `score-trials`, with a summary.
Job score_job(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options);

/// Hash of all that determines the tables.
std::string score_identity(const model::Scene& scene, const ExternalMotion& external, const ScoreOptions& options);

}  // namespace drape::bench
