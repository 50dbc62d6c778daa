#pragma once

#include "bench/studies/work_precision/runs.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// A scene with all that was run on it. `runs` point into `configurations`.
struct SceneRuns {
  Problem problem;
  std::vector<Configuration> configurations;
  std::vector<ComparedRun> runs;
  const SceneRuns* training = nullptr;  ///< another scene, on which configurations were chosen for this one
};

/// What run(all, checkpoint) makes of All{item} for each item. They do not move, since runs point into what is in them.
template <class All, class Item, class Run>
std::vector<All> run_each(const std::vector<Item>& items, const Run& run, Checkpoint& checkpoint) {
  std::vector<All> every;
  every.reserve(items.size());
  checkpoint.each(items, [&](const Item& item) { run(every.emplace_back(All{item, {}}), checkpoint); });
  return every;
}

/// How many configurations of ours or of SUNDIALS were tried on a scene.
int number_of_configurations(const SceneRuns& scene, bool ours);

/// All runs of a scene, for the file and its plot.
results::Table runs_table(const SceneRuns& scene);

/// With hindsight: for errors of 1e-1 to 1e-7 the quickest of each contender and the ratios to ours.
results::Table winners_table(const std::vector<SceneRuns>& scenes);

/// For the overview: the same of ours and of SUNDIALS only; and the least, median and largest ratio of each scene.
results::Table quickest_table(const std::vector<SceneRuns>& scenes);
results::Table peers_summary_table(const std::vector<SceneRuns>& scenes);

/// Without: configurations of both sides that were the quickest on another scene, judged on this one.
results::Table held_out_table(const std::vector<SceneRuns>& scenes);

/// One fixed setting of each side.
results::Table recommended_table(const std::vector<SceneRuns>& scenes);

/// The configurations that these two tables ask for on a scene.
std::set<std::string> named_configurations(const SceneRuns& scene);

/// How each method, with the program's defaults, compares with our best choice over all scenes and errors.
results::Table defaults_table(const std::vector<SceneRuns>& scenes);

/// The bars of the study.
results::Table bars_table(const std::vector<SceneRuns>& scenes);

}  // namespace drape::bench
