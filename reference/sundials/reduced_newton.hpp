#pragma once

#include <optional>

#include "reference/newton_solves.hpp"
#include "solver/linear/newton_factor.hpp"
#include "solver/stage/stage_system.hpp"

namespace drape::reference {

/// The Newton system of positions and velocities, reduced to velocities:
///
///     dx − γ dv = p,   M dv − γ (∂f/∂x dx + ∂f/∂v dv) = q     ⇔     N dv = q + γ ∂f/∂x p,   dx = p + γ dv
///
/// with N = M − γ² ∂f/∂x − γ ∂f/∂v, or an approximation of it. Only the constructor and the first factorisation allocate.
class ReducedNewton {
 public:
  /// The ODE must outlive this object. `kept`: the constant matrix is not factored again for a γ that differs by less than
  /// this part.
  ReducedNewton(const solver::SplitOde& ode, NewtonSolve::Matrix matrix, double kept);

  /// Factors N at a state. False if it is not positive definite.
  bool prepare(double t, const solver::State& y, double gamma);

  /// What it was prepared for.
  double gamma() const { return gamma_; }

  /// Sets df = ∂f/∂x dx + ∂f/∂v dv, the latter only if there is a dv, at a state where the force is f: K dx + D dv for the
  /// constant matrix, which does not ask for f; else a difference quotient.
  template <class Force>
  void derivative(double t, const solver::State& y, const Force& f, const solver::Vectors& dx, const solver::Vectors* dv,
                  solver::Vectors& df) {
    if (constant_)
      multiply(dx, dv, df);
    else if (const double part = move(y, dx, dv); part > 0) {
      ode_.force(t, moved_.x, moved_.v, df);
      df = (df - f()) / part;
    } else
      df.setZero();
  }

  /// dv with N dv = b in the free coordinates, 0 in the pinned ones, valid until the next call.
  const solver::Vectors& solve(solver::Vectors& b);

 private:
  void multiply(const solver::Vectors& dx, const solver::Vectors* dv, solver::Vectors& df);

  /// Sets `moved` to y moved by a small part of the direction, and returns that part; 0 if the direction is.
  double move(const solver::State& y, const solver::Vectors& dx, const solver::Vectors* dv);

  const solver::SplitOde& ode_;
  solver::SparseMatrix matrix_;
  std::optional<solver::NewtonFactor> factor_;  ///< of the matrix
  std::optional<solver::StageSystem> constant_;
  double kept_, gamma_ = 0;
  solver::State moved_;
  solver::Vectors dv_;
};

}  // namespace drape::reference
