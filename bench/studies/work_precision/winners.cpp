#include "bench/studies/work_precision/winners.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/studies/work_precision/peers.hpp"

namespace drape::bench {
namespace {

void add(Score& score, const Winner& best, const Winner& winner) {
  ++score.cells;
  if (!winner) {
    ++score.missed;
    return;
  }
  const double ratio = winner.time / best.time;
  score.log_sum += std::log(ratio);
  score.worst = std::max(score.worst, ratio);
  score.within += ratio <= default_bar || tie(best, winner);
}

}  // namespace

std::string Winner::name() const {
  return trial == nullptr ? "none" : fmt::format("{}: {:.2g}", trial->family->name, trial->configuration().value);
}

bool tie(const Winner& a, const Winner& b) { return a.trial == b.trial || results::tied(a.trial->measured, b.trial->measured); }

Winner Winners::of(const std::string& contender, double error) const {
  const auto found = std::ranges::find(contenders_, contender, &Contender::name);
  if (found == contenders_.end()) return {};
  const auto best = results::quickest(timed(*found, scene_.trials), error);
  if (!best) return {};
  const Trial& trial = scene_.trials[found->members[*best]];
  return {&trial, results::quartiles(trial.measured.times).median};
}

std::vector<std::string> packages() {
  std::vector<std::string> names;
  for (const PeerSetup& setup : peer_setups(Search::full))
    if (std::ranges::find(names, setup.package) == names.end()) names.push_back(setup.package);
  return names;
}

bool is_peer_edge(const SceneTrials& scene) { return scene.problem.scene.name == "peer-edge"; }

std::vector<Score> scores(const std::vector<SceneTrials>& scenes) {
  std::vector<Score> all;
  for (const SceneTrials& scene : scenes)
    for (const Contender& contender : contenders(scene.trials))
      if (contender.name.starts_with("default ") && std::ranges::find(all, contender.name, &Score::contender) == all.end())
        all.push_back({contender.name});
  for (const SceneTrials& scene : scenes) {
    const Winners winners(scene);
    for (const double error : levels(scene.problem))
      if (const Winner best = winners.of("ours", error))
        for (Score& score : all) add(score, best, winners.of(score.contender, error));
  }
  std::ranges::sort(all, {}, [](const Score& score) { return score.mean(); });
  return all;
}

std::string usual_choice(const std::vector<SceneTrials>& scenes) {
  const auto all = scores(scenes);
  return all.empty() ? "" : all.front().contender;
}

}  // namespace drape::bench
