#pragma once

#include <cmath>

#include "bench/studies/work_precision/tables.hpp"

namespace drape::bench {

/// The quickest run of a contender at an error.
struct Winner {
  const ComparedRun* run = nullptr;
  double time = NAN;  ///< median [ms]

  explicit operator bool() const { return run != nullptr; }

  /// The configuration and the value of what controls it; "none" if nothing reaches the error.
  std::string name() const;
};

/// The quickest of those that were timed repeatedly.
Winner winner(const SceneRuns& scene, const Contender& contender, double error);

/// Whether the gap between two is below the noise.
bool tie(const Winner& a, const Winner& b);

/// The packages of SUNDIALS.
std::vector<Code> packages();

/// A bar about the scene peer-edge with 100 × 100 particles: an error [m] and its limit in seconds per simulated second.
struct PeerBar {
  const char* name;
  bool (Configuration::*contender)() const;
  double error, seconds;
};
inline constexpr PeerBar peer_bars[] = {{"implicit", &Configuration::is_implicit, 5e-2, 0.4},
                                        {"ours", &Configuration::is_ours, 5e-3, 0.7},
                                        {"ours", &Configuration::is_ours, 3e-4, 0.5}};

constexpr double default_bar = 1.5;

/// Ratios of one method, with automatic stages and linear solvers, to our best choice.
struct Score {
  DefaultChoice choice;
  std::vector<double> ratios = {};  ///< of scenes and errors; 10 for those not reached
  int missed = 0;                   ///< of these not reached
  int within = 0;                   ///< of these at most `default_bar`, or tied with the best
  double worst = 1;                 ///< of those reached

  double mean() const;  ///< geometric; infinite if there are no ratios
};

/// Best first, by the mean ratio.
std::vector<Score> scores(const std::vector<SceneRuns>& scenes);

/// The choice that scores best; none if there is none.
DefaultChoice usual_choice(const std::vector<SceneRuns>& scenes);

}  // namespace drape::bench
