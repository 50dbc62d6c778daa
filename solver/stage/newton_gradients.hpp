#pragma once

#include <vector>

#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Conjugate gradients for a Newton matrix J. The preconditioner is the sum of two: the preconditioner of the constant matrix A
/// of the same γ, which has the springs of the whole sheet but as stiff across as along; and the inverses of the 3 × 3 blocks
/// on the diagonal of J, which are soft where the cloth is slack.
///
/// They end when the residual and the error of d are small. The test |J d − r| ≤ η |r| is that of an inexact Newton method
/// [Dembo, Eisenstat, Steihaug 1982]. It does not bound the error of d where springs are stiff and the cloth is slack: there d
/// is almost entirely in modes of little stiffness, which contribute next to nothing to r. So that |d| estimates the error of v
/// as it does with a factor, the error of d must also be a small part of d: in the norm of J, in which conjugate gradients give
/// its decrease with every iteration [Hestenes, Stiefel 1952]; as J ≥ M it is no smaller than in the norm of M. Wherever they
/// end, <r, d> > 0, as a line search needs.
class NewtonGradients {
 public:
  /// `system`: provides A; of the same ODE.
  NewtonGradients(const SplitOde& ode, const Options& options, StageSystem& system);

  /// Prepares for new values of J: the upper triangle, 3N × 3N.
  void prepare(const SparseMatrix& J);

  /// J d ≈ r for the matrix that was prepared last, made for this γ and μ; r is 0 in pinned coordinates.
  LinearResult solve(const SparseMatrix& J, double gamma, double inertia, const Vectors& r, Vectors& d);

 private:
  double precondition();
  bool settled(const Vectors& d) const;

  const SplitOde& ode_;
  const int max_iterations_;
  StageSystem& system_;
  std::vector<Eigen::Matrix3d> blocks_;  ///< inverses of the blocks on the diagonal of J
  Eigen::Array<double, 5, 1> falls_;     ///< decreases of the squared error of d in the norm of J, in the last iterations
  Vectors r_, z_, p_, q_;
  LinearCounters work_;
};

}  // namespace drape::solver
