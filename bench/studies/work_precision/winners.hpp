#pragma once

#include <cmath>

#include "bench/studies/work_precision/tables.hpp"

namespace drape::bench {

/// The quickest trial of a contender at an error.
struct Winner {
  const Trial* trial = nullptr;
  double time = NAN;  ///< median [ms]

  explicit operator bool() const { return trial != nullptr; }

  /// The family and the value of what controls it; "none" if nothing reaches the error.
  std::string name() const;
};

/// Whether the gap between two is below the noise.
bool tie(const Winner& a, const Winner& b);

/// All winners of a scene.
class Winners {
 public:
  explicit Winners(const SceneTrials& scene) : scene_(scene), contenders_(contenders(scene.trials)) {}

  Winner of(const std::string& contender, double error) const;

 private:
  const SceneTrials& scene_;
  std::vector<Contender> contenders_;
};

/// The packages of SUNDIALS.
std::vector<std::string> packages();

/// Where errors are in metres and times are compared with other codes'.
bool is_peer_edge(const SceneTrials& scene);

/// A bar about 100 × 100 particles of that scene: an error [m] and its limit in seconds per simulated second.
struct PeerBar {
  const char* contender;
  double error, seconds;
};
inline constexpr PeerBar peer_bars[] = {{"implicit", 5e-2, 0.4}, {"ours", 5e-3, 0.7}, {"ours", 3e-4, 0.5}};

/// Ratios of one method, with automatic stages and linear solvers, to our best choice.
struct Score {
  std::string contender;
  int cells = 0;   ///< scenes and errors
  int missed = 0;  ///< of these not reached
  int within = 0;  ///< of these at most `default_bar`, or tied with the best
  double log_sum = 0, worst = 1;

  /// Geometric mean of the ratios to our best, with those not reached as ten times slower.
  double mean() const { return std::exp((log_sum + missed * std::log(10.0)) / std::max(1, cells)); }
};

constexpr double default_bar = 1.5;

/// Best first, by the mean ratio.
std::vector<Score> scores(const std::vector<SceneTrials>& scenes);

/// The contender that scores best; empty if there is none.
std::string usual_choice(const std::vector<SceneTrials>& scenes);

}  // namespace drape::bench
