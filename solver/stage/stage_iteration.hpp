#pragma once

#include <memory>

#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Solves stages without contacts by an iteration that ends as the fixed-point loop does: when |r| ≤ η |b|, with b where the
/// stage began, or after the passes that the options accept.
class StageIteration {
 public:
  StageIteration(const SplitOde& ode, const Options& options, StageSystem& system);
  StageIteration(const StageIteration&) = delete;
  StageIteration& operator=(const StageIteration&) = delete;
  virtual ~StageIteration() = default;

  /// y: with the first guess of v. An iteration that diverges ends as `not_converged` or `not_finite`.
  StageResult solve(const Stage& stage, State& y);

 protected:
  /// A stage begins at y.
  virtual void begin(const State& y) = 0;

  /// Replaces y.v by the next iterate and evaluates the residual there. `target`: of |r| [N s] in the system with A.
  virtual LinearResult advance(const Stage& stage, State& y, double target) = 0;

  /// Evaluates the residual at y, in the free directions.
  void evaluate(const Stage& stage, State& y);

  const SplitOde& ode() const { return ode_; }
  StageSystem& system() { return system_; }
  const StageSystem& system() const { return system_; }

 private:
  const SplitOde& ode_;
  const Options& options_;
  StageSystem& system_;
  LinearCounters work_;
};

/// The iteration that the options' stage solver asks for; null if that is one of the thesis' loops. Throws
/// std::invalid_argument if it needs a newton_matrix that the ODE does not have.
std::unique_ptr<StageIteration> make_iteration(const SplitOde& ode, const Options& options, StageSystem& system);

}  // namespace drape::solver
