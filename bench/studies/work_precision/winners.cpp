#include "bench/studies/work_precision/winners.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/studies/work_precision/peers.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

void add(Score& score, const Winner& best, const Winner& own) {
  constexpr double ratio_if_missed = 10;
  const double ratio = own ? own.time / best.time : ratio_if_missed;
  score.ratios.push_back(ratio);
  if (!own) {
    ++score.missed;
    return;
  }
  score.worst = std::max(score.worst, ratio);
  score.within += ratio <= default_bar || tie(best, own);
}

std::vector<Score> empty_scores(const std::vector<SceneRuns>& scenes) {
  std::vector<Score> all;
  for (const SceneRuns& scene : scenes)
    for (const Configuration& configuration : scene.configurations)
      if (const DefaultChoice choice{configuration.by_default, configuration.control};
          configuration.is_default() && std::ranges::find(all, choice, &Score::choice) == all.end())
        all.push_back({choice});
  return all;
}

}  // namespace

std::string Winner::name() const {
  return run == nullptr ? "none" : fmt::format("{}: {:.2g}", run->configuration->name, run->variant().value);
}

Winner winner(const SceneRuns& scene, const Contender& contender, double error) {
  const ComparedRun* best = quickest(contender, scene.runs, error);
  if (best == nullptr) return {};
  return {best, results::quartiles(best->measured.times).median};
}

bool tie(const Winner& a, const Winner& b) { return a.run == b.run || results::tied(a.run->measured, b.run->measured); }

std::vector<Code> packages() {
  std::vector<Code> all;
  for (const PeerSetup& setup : peer_setups(Search::full))
    if (std::ranges::find(all, setup.package) == all.end()) all.push_back(setup.package);
  return all;
}

double Score::mean() const { return ratios.empty() ? INFINITY : base::geometric_mean(ratios); }

std::vector<Score> scores(const std::vector<SceneRuns>& scenes) {
  std::vector<Score> all = empty_scores(scenes);
  for (const SceneRuns& scene : scenes)
    for (const double error : levels(scene.problem))
      if (const Winner best = winner(scene, &Configuration::is_ours, error))
        for (Score& score : all) add(score, best, winner(scene, score.choice, error));
  std::ranges::sort(all, {}, [](const Score& score) { return score.mean(); });
  return all;
}

DefaultChoice usual_choice(const std::vector<SceneRuns>& scenes) {
  const auto all = scores(scenes);
  return all.empty() ? DefaultChoice{} : all.front().choice;
}

}  // namespace drape::bench
