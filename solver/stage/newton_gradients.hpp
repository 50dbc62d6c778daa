#pragma once

#include <vector>

#include "solver/stage/stage_system.hpp"

namespace drape::solver {

/// Conjugate gradients for a Newton matrix J. The preconditioner is the sum of two: what solves with the constant matrix A of
/// the same γ, which knows the springs of the whole sheet but takes them for as stiff across as along; and the inverses of the
/// 3 × 3 blocks on the diagonal of J, which know where the cloth is slack.
///
/// They end when two parts are small. That of the residual, |J d − r| ≤ η |r|, is the forcing term of an inexact Newton method
/// [Dembo, Eisenstat, Steihaug 1982]. It says little of d where springs are stiff and the cloth is slack: there d is almost all
/// in modes that resist with hardly more than their mass and that have next to no part in r. So that |d| tells how far off v is
/// as with a factor, the error of d must also be a small part of d: in the norm of J, in which conjugate gradients know by how
/// much it falls with every iteration [Hestenes, Stiefel 1952]; as J ≥ M it is no smaller in the norm of M. Wherever they end,
/// <r, d> > 0, as a line search needs.
class NewtonGradients {
 public:
  /// `system`: of the same ODE, for its A.
  NewtonGradients(const SplitOde& ode, const Options& options, StageSystem& system);

  /// Prepares for new values of J: the upper triangle, 3N × 3N.
  void prepare(const SparseMatrix& J);

  /// J d ≈ r for the matrix that was prepared last, made for this γ; r is 0 in pinned coordinates.
  LinearResult solve(const SparseMatrix& J, double gamma, const Vectors& r, Vectors& d);

 private:
  double precondition();
  bool settled(const Vectors& d) const;

  const SplitOde& ode_;
  const int max_iterations_;
  StageSystem& system_;
  std::vector<Eigen::Matrix3d> blocks_;  ///< inverses of those on the diagonal of J
  Eigen::Array<double, 5, 1> falls_;     ///< of the squared error of d in the norm of J, over the last iterations
  Vectors r_, z_, p_, q_;
  LinearCounters work_;
};

}  // namespace drape::solver
