#pragma once

#include <optional>

#include "solver/linear/newton_factor.hpp"
#include "solver/stage/newton_gradients.hpp"

namespace drape::solver {

/// A Newton matrix and what solves with it, kept until it is asked to be renewed. If the linear solver of the options is
/// `cholesky`, that is the matrix' complete factor; `ic0`, `mic0` and `multigrid` are conjugate gradients on it with what these
/// make of the constant matrix (NewtonGradients); `auto` factors up to 2500 particles. What was never needed takes no
/// memory.
class NewtonSystem {
 public:
  NewtonSystem(const SplitOde& ode, const Options& options, StageSystem& system, Jacobian part);

  bool empty() const { return gamma_ == 0; }
  double gamma() const { return gamma_; }  ///< that it was made for, 0 if there is none

  /// Evaluates the Jacobian at this state, and factors it if a factor is wanted.
  Outcome renew(double t, const State& y, double gamma);

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
  double gamma_ = 0;
};

}  // namespace drape::solver
