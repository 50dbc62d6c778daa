#pragma once

#include <span>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// Positions at time t of a step from t0 to t1: the cubic with the positions and velocities of both ends, N × 3. Between exact
/// states its largest error is O((t1 − t0)⁴)   [Hairer, Nørsett, Wanner 1993, II.6].
Vectors positions_within(double t, double t0, const State& y0, double t1, const State& y1);

/// Takes the positions at given times out of a run, whatever its steps.
class DenseOutput {
 public:
  /// `times` [s]: ascending, none before t0; they must outlive this object.
  DenseOutput(std::span<const double> times, double t0, State y0);

  /// The end of the next step.
  void see(double t, const State& y);

  /// At all times that were reached, N × 3 each.
  std::vector<Vectors> positions;

 private:
  std::span<const double> times_;
  double t_;
  State before_;
};

}  // namespace drape::solver
