#pragma once

#include "solver/options.hpp"
#include "solver/stage/newton_system.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Newton's method with a new matrix for every update and line searches: slow but robust.
///
/// Along an update d the slope r(v + α d)·d falls from r(v)·d > 0; the search ends at an α where it is small. If forces have a
/// potential, that is near the minimum along d of the energy whose minimum solves the stage; no energy is evaluated.
class NewtonSearch {
 public:
  NewtonSearch(const SplitOde& ode, const Options& options, StageSystem& system);

  /// Continues from y.v; guess: where the stage began. Adds to the result's updates and sets its outcome. `newton`: with the
  /// whole Jacobian.
  void solve(const Stage& stage, const Vectors& guess, NewtonSystem& newton, State& y, StageResult& result);

 private:
  void evaluate(const Stage& stage, State& y);
  double slope() const;
  bool follow(const Stage& stage, State& y);

  const Options& options_;
  StageSystem& system_;
  Vectors from_, d_;
  LinearCounters work_;
  std::int64_t& stages_;
};

}  // namespace drape::solver
