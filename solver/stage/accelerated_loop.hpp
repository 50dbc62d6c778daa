#pragma once

#include "solver/stage/anderson.hpp"
#include "solver/stage/auto_policy.hpp"
#include "solver/stage/error_estimate.hpp"
#include "solver/stage/newton_search.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Solves stages without contacts by Anderson's method. What it accelerates is the iteration v ← v + P⁻¹ r(v), where P is the
/// constant matrix A or a Newton matrix, which is kept until convergence slows. An update that leads away is taken back and
/// tried with a smaller part, or with a new matrix; where that does not help, NewtonSearch goes on.
///
/// It ends when the estimate of the error of v (ErrorEstimate) is a small part of the error of the time step, which the
/// distance between solution and first guess tells (Stage::accuracy).
class AcceleratedLoop {
 public:
  AcceleratedLoop(const SplitOde& ode, const Options& options, StageSystem& system);

  /// y: with the first guess of v.
  StageResult solve(const Stage& stage, State& y);

 private:
  using Matrix = StageKind::Matrix;

  void begin(const Stage& stage, const State& y);
  void start_iteration();
  void reset();
  bool find_matrix(State& y);
  void recycle();
  bool use_newton(NewtonSystem* matrix, State& y);
  bool correct();
  bool backtrack(State& y);
  bool search(State& y);
  bool switch_to_newton(State& y);
  void advance(State& y);
  bool close_enough(const State& y) const;
  bool may_switch() const;
  bool estimate_unreliable() const;
  bool stagnates() const;
  NewtonSystem* preferred();
  StageResult ended(Outcome outcome);

  const SplitOde& ode_;
  const Options& options_;
  StageSystem& system_;
  ErrorEstimate estimate_;
  Anderson anderson_;
  NewtonSystem newton_, tension_newton_;
  NewtonSearch search_;
  Vectors guess_;
  Vectors best_v_, best_d_;  ///< where |d| was smallest since the last renewal

  // Of the stage that is being solved.
  const Stage* stage_ = nullptr;
  StageResult result_;
  NewtonSystem* matrix_ = nullptr;  ///< P; null for A
  double noise_ = 0;                ///< what of it is round-off
  double size_ = 0;                 ///< |d|
  double best_ = 0;                 ///< smallest |d|
  double part_ = 1;                 ///< of an update that is made
  double rate_ = 0;                 ///< by which |d| changed last
  int since_renewal_ = 0, renewals_here_ = 0;
  bool made_here_ = false;  ///< P was made at best_v_; A is what it is everywhere
  bool searched_ = false;   ///< the stage was solved by line searches

  // What serves on in the next stage, if P is the same.
  NewtonSystem* recycled_matrix_ = nullptr;
  double recycled_gamma_ = 0;  ///< of A [s]

  AutoPolicy policy_;
  LinearCounters work_;
};

}  // namespace drape::solver
