#pragma once

#include <vector>

#include "solver/linear/conjugate_gradients.hpp"

namespace drape::solver {

/// Conjugate gradients for the symmetric part of a matrix with 3N rows, preconditioned by the inverses of its 3 × 3 blocks on
/// the diagonal   [Baraff, Witkin 1998, 5.3]. Only the constructor allocates.
class BlockJacobiGradients {
 public:
  BlockJacobiGradients(int particles, Counters& work);

  /// Inverts the blocks of A; M takes the place of one that is not positive definite.
  void prepare(const SparseMatrix& A, const Eigen::VectorXd& mass);

  /// ½ (A + Aᵀ) d = r from d = 0 until |residual| ≤ target; r is overwritten with the residual. Negative curvature is not an
  /// obstacle: on indefinite matrices the iteration may not converge.
  LinearResult solve(const SparseMatrix& A, Vectors& r, Vectors& d, double target, int max_iterations);

 private:
  double precondition(const Vectors& r);
  void multiply_symmetric(const SparseMatrix& A);

  std::vector<Eigen::Matrix3d> inverses_;
  Vectors z_, p_, q_;
  LinearCounters work_;
};

}  // namespace drape::solver
