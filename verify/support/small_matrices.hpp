#pragma once

#include <vector>

#include "verify/support/known_motions.hpp"

/// Small matrices of all kinds of patterns, for the tests of linear algebra.
namespace drape::verify::small_matrices {

using solver::SparseMatrix;

/// Sizes that are and are not multiples of what the kernels take at once.
inline constexpr int sizes[] = {1, 2, 3, 4, 7, 16, 400};

/// Random entries with this probability; some rows and columns stay empty.
SparseMatrix scattered(int n, double density, unsigned seed);

SparseMatrix diagonal(const Eigen::VectorXd& d);

/// Symmetric positive definite: diagonally dominant by a little.
SparseMatrix definite(int n, double density, unsigned seed);

SparseMatrix tridiagonal(int n);

/// M − K of a sheet of springs: as in the stage, except at its edges.
SparseMatrix sheet(int nu, int nv);

/// Matrices with all kinds of patterns.
std::vector<SparseMatrix> definite_matrices();

}  // namespace drape::verify::small_matrices
