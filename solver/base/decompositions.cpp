#include "solver/base/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>
#include <memory>

namespace drape::base {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) { return A.eigenvalues(); }

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Eigen::VectorXd tridiagonal_eigenvalues(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues();
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) { return A.completeOrthogonalDecomposition().pseudoInverse(); }

std::function<Eigen::VectorXd(const Eigen::VectorXd& b)> lu_inverse(const Eigen::SparseMatrix<double>& A) {
  const auto lu = std::make_shared<const Eigen::SparseLU<Eigen::SparseMatrix<double>>>(A);
  if (lu->info() != Eigen::Success) return {};
  return [lu](const Eigen::VectorXd& b) -> Eigen::VectorXd { return lu->solve(b); };
}

}  // namespace drape::base
