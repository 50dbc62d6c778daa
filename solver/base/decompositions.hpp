#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <functional>

/// Decompositions of matrices without a sparse definite structure to use. They are here and not where they are needed because
/// each costs the compiler several seconds wherever it is instantiated.
namespace drape::base {

/// Eigenvalues of a square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< orthonormal columns
};

/// Eigenvalues and eigenvectors of a symmetric matrix, of which only the lower triangle is read.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// Eigenvalues of a symmetric tridiagonal matrix, ascending. `beside`: the entries beside the diagonal, one less than on it.
Eigen::VectorXd tridiagonal_eigenvalues(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);

/// The pseudo-inverse of a small matrix.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

/// b ↦ A⁻¹ b by sparse LU decomposition with pivoting; empty if A is singular.
std::function<Eigen::VectorXd(const Eigen::VectorXd& b)> lu_inverse(const Eigen::SparseMatrix<double>& A);

}  // namespace drape::base
