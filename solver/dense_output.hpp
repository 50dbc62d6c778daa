#pragma once

#include <span>
#include <vector>

#include "solver/state.hpp"

namespace drape::solver {

/// The state at time t of a step from t0 to t1: the cubic with the positions and velocities of both ends, and its derivative.
/// Between exact states the largest error of positions is O((t1 − t0)⁴), of velocities O((t1 − t0)³)   [Hairer, Nørsett, Wanner
/// 1993, II.6]. Internal variables are on the line between both ends.
State state_within(double t, double t0, const State& y0, double t1, const State& y1);

/// Interpolates the states of a run at given times, whatever its steps.
class DenseOutput {
 public:
  /// `times` [s]: ascending, none before t0; they must outlive this object.
  DenseOutput(std::span<const double> times, double t0, State y0);

  /// Adds the end of the next step.
  void observe(double t, const State& y);

  /// States at all times that were reached.
  std::vector<State> states;

 private:
  std::span<const double> times_;
  double t_;
  State before_;
};

/// Positions at given times of a run that meets no obstacle: the quintic with the positions and velocities of three steps'
/// ends, which preserves the accuracy of methods of high order. Its largest error is O(h⁶), in the first step O(h⁴).
class SmoothOutput {
 public:
  /// `times` [s]: ascending, none before t0; they must outlive this object.
  SmoothOutput(std::span<const double> times, double t0, const State& y0) : times_(times), last_{{t0, y0}} {}

  /// Adds the end of the next step.
  void observe(double t, const State& y);

  /// Positions at all times that were reached.
  std::vector<Vectors> positions;

 private:
  struct End {
    double t;
    State y;
  };
  Vectors positions_at(double t) const;

  std::span<const double> times_;
  std::vector<End> last_;  ///< the newest at the back
};

}  // namespace drape::solver
