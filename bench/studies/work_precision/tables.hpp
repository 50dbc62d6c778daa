#pragma once

#include "bench/studies/work_precision/runs.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// A scene with all that was tried on it. `trials` point into `families`.
struct SceneTrials {
  Problem problem;
  std::vector<Family> families;
  std::vector<Trial> trials;
  const SceneTrials* training = nullptr;  ///< another scene, on which families were chosen for this one
};

/// How many families of ours or of SUNDIALS were tried on a scene.
int number_of_families(const SceneTrials& scene, bool ours);

/// All trials of a scene, for the file and its plot.
results::Table trials_table(const SceneTrials& scene);

/// With hindsight: for errors of 1e-1 to 1e-7 the quickest of each contender and the ratios to ours.
results::Table winners_table(const std::vector<SceneTrials>& scenes);

/// For the overview: the same of ours and of SUNDIALS only; and the least, median and largest ratio of each scene.
results::Table quickest_table(const std::vector<SceneTrials>& scenes);
results::Table peers_summary_table(const std::vector<SceneTrials>& scenes);

/// Without: families of both sides that were the quickest on another scene, judged on this one.
results::Table held_out_table(const std::vector<SceneTrials>& scenes);

/// One fixed setting of each side.
results::Table recommended_table(const std::vector<SceneTrials>& scenes);

/// The families that these two tables ask for on a scene.
std::set<std::string> named_families(const SceneTrials& scene);

/// How each method, with the program's defaults, compares with our best choice over all scenes and errors.
results::Table defaults_table(const std::vector<SceneTrials>& scenes);

/// The bars of the study.
results::Table bars_table(const std::vector<SceneTrials>& scenes);

/// The errors [m] of other codes on the scene peer-edge, and those of the bars about it.
std::vector<double> peer_errors();

/// Other codes' figures on the scene peer-edge, and ours.
results::Table peers_table(const std::vector<SceneTrials>& scenes);

}  // namespace drape::bench
