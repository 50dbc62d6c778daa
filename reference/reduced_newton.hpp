#pragma once

#include <optional>

#include "reference/newton_solves.hpp"
#include "solver/newton_factor.hpp"
#include "solver/stage_system.hpp"

namespace drape::reference {

/// The Newton system of positions and velocities, reduced to velocities:
///
///     dx − γ dv = p,   M dv − γ (∂f/∂x dx + ∂f/∂v dv) = q     ⇔     N dv = q + γ ∂f/∂x p,   dx = p + γ dv
///
/// with N = M − γ² ∂f/∂x − γ ∂f/∂v, or what stands for it.
class ReducedNewton {
 public:
  /// The ODE must outlive this object.
  ReducedNewton(const solver::SplitOde& ode, NewtonSolve::Matrix matrix);

  /// Factors N at a state. False if it is not positive definite.
  bool prepare(double t, const solver::State& y, double gamma);

  double gamma() const { return gamma_; }

  /// ∂f/∂x dx + ∂f/∂v dv at a state: a difference quotient, or K dx + D dv for the constant matrix.
  solver::Vectors derivative(double t, const solver::State& y, const solver::State& direction) const;

  /// dv with N dv = b in the free coordinates, 0 in the pinned ones.
  solver::Vectors solve(solver::Vectors b);

 private:
  const solver::SplitOde& ode_;
  solver::SparseMatrix matrix_;
  std::optional<solver::NewtonFactor> factor_;  ///< of the matrix
  std::optional<solver::StageSystem> constant_;
  double gamma_ = 0;
};

}  // namespace drape::reference
