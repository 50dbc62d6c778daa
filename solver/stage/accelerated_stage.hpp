#pragma once

#include "solver/stage/anderson.hpp"
#include "solver/stage/auto_policy.hpp"
#include "solver/stage/error_estimate.hpp"
#include "solver/stage/lagged_newton.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Solves stages without contacts by Anderson's method, which accelerates the iteration v ← v + P⁻¹ r(v); P is the constant
/// matrix A or a Newton matrix (LaggedNewton). An update that makes |d| grow too much is undone and tried with a smaller part,
/// or with a new matrix; where that does not help, a line search follows.
///
/// It ends when the estimate of the error of v (ErrorEstimate) is a small part of the error of the time step, which the
/// distance between solution and first guess indicates (Stage::accuracy); or when |r| is small, if Stage::residual says so.
class AcceleratedStage {
 public:
  AcceleratedStage(const SplitOde& ode, const Options& options, StageSystem& system);

  /// y: with the first guess of v.
  StageResult solve(const Stage& stage, State& y);

 private:
  void begin(const Stage& stage, const State& y);
  void start_iteration();
  bool find_matrix(State& y);
  void recycle();
  bool renew_matrix(State& y);
  bool correct();
  bool backtrack(State& y);
  bool search(State& y);
  bool switch_to_newton(State& y);
  void advance(State& y);
  bool close_enough(const State& y) const;
  bool may_switch() const { return policy_.may_switch() && !newton_.in_use(); }
  StageResult ended(Outcome outcome);

  const SplitOde& ode_;
  const Options& options_;
  StageSystem& system_;
  ErrorEstimate estimate_;
  Anderson anderson_;
  LaggedNewton newton_;
  Vectors guess_;
  Vectors best_v_, best_d_;  ///< where |d| was smallest since the iteration began

  // State of the stage that is being solved.
  const Stage* stage_ = nullptr;
  StageResult result_;
  double noise_ = 0;       ///< round-off in |r|
  double size_ = 0;        ///< |d|
  double best_ = 0;        ///< smallest |d|
  double part_ = 1;        ///< of an update that is made
  double rate_ = 0;        ///< |d| over the smallest before
  bool improved_ = false;  ///< best_v_ is not where the iteration began
  bool searched_ = false;  ///< the stage was solved by line searches

  // The P whose differences Anderson's method keeps for the next stage.
  const NewtonSystem* recycled_matrix_ = nullptr;
  double recycled_gamma_ = 0;  ///< of A [s]

  AutoPolicy policy_;
  LinearCounters work_;
};

}  // namespace drape::solver
