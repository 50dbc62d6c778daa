#pragma once

#include "bench/studies/work_precision_runs.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// A scene with all that was tried on it. `trials` point into `families`.
struct SceneTrials {
  Problem problem;
  std::vector<Family> families;
  std::vector<Trial> trials;
};

/// All trials of a scene, for the file and its plot.
results::Table trials_table(const SceneTrials& scene);

/// For errors of 1e-1 to 1e-7 the quickest of each contender and the ratios to ours.
results::Table winners_table(const std::vector<SceneTrials>& scenes);

/// How each method, with the program's defaults, compares with our best choice over all scenes and errors.
results::Table defaults_table(const std::vector<SceneTrials>& scenes);

/// The bars of the study.
results::Table bars_table(const std::vector<SceneTrials>& scenes);

/// The errors [m] of other codes on the scene peer-edge, and those of the bars about it.
std::vector<double> peer_errors();

/// Other codes' figures on the scene peer-edge, and ours.
results::Table peers_table(const std::vector<SceneTrials>& scenes);

}  // namespace drape::bench
