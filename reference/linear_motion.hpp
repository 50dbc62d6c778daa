#pragma once

#include <cstddef>
#include <vector>

#include "reference/trajectory.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::reference {

/// The motion of a small perturbation, linearised about a trajectory: M d²x/dt² = K(t) x + D(t) dx/dt with the exact Jacobians
/// K = ∂f/∂x and D = ∂f/∂v, solved by the midpoint rule with equal steps. Its transpose is exact: that of every step, in
/// reverse order.
class LinearMotion {
 public:
  /// A step whose linear system could not be solved.
  class NotSolved : public std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  /// `middles`: the trajectory's states in the middle of each of the steps, which are `h` [s] long.
  LinearMotion(const solver::SplitOde& ode, Trajectory middles, double h);
  LinearMotion(const LinearMotion&) = delete;
  LinearMotion& operator=(const LinearMotion&) = delete;

  /// Positions at the ends of the steps, of a perturbation that is `start` at the beginning. Throws NotSolved.
  std::vector<solver::Vectors> forward(solver::State start);

  /// The transpose: the sum over all steps of Pᵀ w, where P takes a start to the positions at the end of the step and w is the
  /// step's weight. Throws NotSolved.
  solver::State transposed(const std::vector<solver::Vectors>& weights);

 private:
  void linearise(std::size_t step);
  const solver::Vectors& solve(const solver::Vectors& right);
  solver::Vectors filtered(const Eigen::VectorXd& product) const;

  const solver::SplitOde& ode_;
  const Trajectory middles_;
  const double h_;
  solver::SparseMatrix dx_, dv_, steep_;  ///< K, D, (h/2) K + D of the step
  bool transposed_ = false;
  solver::SplitOde stage_ode_;  ///< of the stage w = right + (h/2) M⁻¹ ((h/2) K + D) w, or with the matrices transposed
  solver::StageSolver stage_;
  solver::State y_;
};

}  // namespace drape::reference
