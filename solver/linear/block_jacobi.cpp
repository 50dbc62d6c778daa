#include "solver/linear/block_jacobi.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "solver/linear/kernels.hpp"

namespace drape::solver {

BlockJacobiGradients::BlockJacobiGradients(int particles, Counters& work)
    : inverses_(particles),
      z_(Vectors::Zero(particles, 3)),
      p_(Vectors::Zero(particles, 3)),
      q_(Vectors::Zero(particles, 3)),
      work_(work) {}

void BlockJacobiGradients::prepare(const SparseMatrix& A, const Eigen::VectorXd& mass) {
  for (int i = 0; i < mass.size(); ++i) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    for (int c = 0; c < 3; ++c)
      for (SparseMatrix::InnerIterator a(A, 3 * i + c); a; ++a)
        if (a.col() / 3 == i) block(c, a.col() % 3) = a.value();
    block = (0.5 * (block + block.transpose())).eval();
    const bool positive = block.llt().info() == Eigen::Success;
    inverses_[i] = positive ? Eigen::Matrix3d(block.inverse()) : Eigen::Matrix3d(Eigen::Matrix3d::Identity() / mass[i]);
  }
}

double BlockJacobiGradients::precondition(const Vectors& r) {
  for (std::size_t i = 0; i < inverses_.size(); ++i) z_.row(i) = r.row(i) * inverses_[i];
  ++work_.preconditioner;
  return r.cwiseProduct(z_).sum();
}

/// q = ½ (A + Aᵀ) p in one pass over A.
void BlockJacobiGradients::multiply_symmetric(const SparseMatrix& A) {
  const double* const p = p_.data();
  double* const q = q_.data();
  q_.setZero();
  for (int i = 0; i < A.rows(); ++i)
    for (SparseMatrix::InnerIterator a(A, i); a; ++a) {
      const double half = 0.5 * a.value();
      q[i] += half * p[a.col()];
      q[a.col()] += half * p[i];
    }
  ++work_.products;
  work_.bytes += multiply_bytes(A) + vector_bytes(p_.rows(), 9);
}

LinearResult BlockJacobiGradients::solve(const SparseMatrix& A, Vectors& r, Vectors& d, double target, int max_iterations) {
  d.setZero(r.rows(), 3);
  p_.setZero();
  double rz = 0;
  for (int k = 0;; ++k) {
    const double norm = r.norm();
    if (!std::isfinite(norm)) return {Outcome::not_finite, k};
    if (norm <= target) return {Outcome::success, k};
    if (k == max_iterations) return {Outcome::not_converged, k};
    const double previous = rz;
    rz = precondition(r);
    p_ = z_ + (k == 0 ? 0 : rz / previous) * p_;
    multiply_symmetric(A);
    ++work_.cg_iterations;
    const double step = rz / p_.cwiseProduct(q_).sum();
    d += step * p_;
    r -= step * q_;
  }
}

}  // namespace drape::solver
