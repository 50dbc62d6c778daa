#pragma once

#include "solver/stage/stage_iteration.hpp"

namespace drape::solver {

/// Chebyshev's semi-iterative method, which combines the next iterate ŷ of an iteration with the one before the last,
/// y ← ω (ŷ − y₋₁) + y₋₁ [Wang 2015, (8), Alg. 1]: optimal where all errors decay by factors between −ρ and ρ.
class ChebyshevWeights {
 public:
  /// `radius`: ρ < 1; `delay`: iterations before the first weight, in which the fastest errors decay.
  ChebyshevWeights(double radius, int delay) : square_(radius * radius), delay_(delay) {}

  void restart() { iterations_ = 0; }

  /// ω of the next iteration: 1 at first, then 2/(2 − ρ²), then 4/(4 − ρ² ω).
  double next();

 private:
  const double square_;  ///< ρ²
  const int delay_;
  int iterations_ = 0;
  double weight_ = 1;
};

/// Iterates of v that are combined with these weights.
class ChebyshevIterates {
 public:
  ChebyshevIterates(Eigen::Index particles, double radius, int delay);

  /// An iteration begins at v.
  void restart(const Vectors& v);

  /// v: the next iterate without acceleration, replaced by the combination; `last`: the iterate that it was made from.
  void combine(const Vectors& last, Vectors& v);

 private:
  ChebyshevWeights weights_;
  Vectors before_;  ///< the iterate before the last
};

/// The fixed-point loop with these weights [Wang 2015].
class ChebyshevLoop : public StageIteration {
 public:
  ChebyshevLoop(const SplitOde& ode, const Options& options, StageSystem& system);

 private:
  void begin(const State& y) override;
  LinearResult advance(const Stage& stage, State& y, double target) override;

  ChebyshevIterates iterates_;
  Vectors last_;
};

}  // namespace drape::solver
