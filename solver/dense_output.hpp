#pragma once

#include <span>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// The state at time t of a step from t0 to t1: the cubic with the positions and velocities of both ends, and its derivative.
/// Between exact states the largest error of positions is O((t1 − t0)⁴), of velocities O((t1 − t0)³)   [Hairer, Nørsett, Wanner
/// 1993, II.6].
State state_within(double t, double t0, const State& y0, double t1, const State& y1);

/// Takes the states at given times out of a run, whatever its steps.
class DenseOutput {
 public:
  /// `times` [s]: ascending, none before t0; they must outlive this object.
  DenseOutput(std::span<const double> times, double t0, State y0);

  /// The end of the next step.
  void see(double t, const State& y);

  /// At all times that were reached.
  std::vector<State> states;

 private:
  std::span<const double> times_;
  double t_;
  State before_;
};

}  // namespace drape::solver
