#pragma once

#include <optional>

#include "solver/linear/newton_factor.hpp"
#include "solver/stage/newton_gradients.hpp"

namespace drape::solver {

/// A Newton matrix with its linear solver, kept until it is renewed. With the options' linear solver `cholesky` that is the
/// matrix' complete factor; with `ic0`, `mic0` and `multigrid` conjugate gradients, preconditioned by these solvers of the
/// constant matrix (NewtonGradients); `auto` factors small matrices (LinearChoice). Memory is allocated at the first renewal.
class NewtonSystem {
 public:
  NewtonSystem(const SplitOde& ode, const Options& options, StageSystem& system, Jacobian part);

  bool empty() const { return gamma_ == 0; }
  double gamma() const { return gamma_; }  ///< γ of the last renewal, 0 if there is no matrix

  /// Evaluates the Jacobian at this state with the stage's γ and μ, and factors it unless conjugate gradients solve.
  Outcome renew(const Stage& stage, const State& y);

  /// J d = r, both N × 3; r is 0 in pinned coordinates.
  LinearResult solve(const Vectors& r, Vectors& d);

 private:
  const SplitOde& ode_;
  const Options& options_;
  StageSystem& system_;
  const Jacobian part_;
  const bool factors_;
  SparseMatrix J_;
  NewtonFactor factor_;                       ///< of J, if it factors
  std::optional<NewtonGradients> gradients_;  ///< if it does not, from the first renewal on
  double gamma_ = 0, inertia_ = 1;
};

}  // namespace drape::solver
