#pragma once

#include <algorithm>
#include <random>
#include <unsupported/Eigen/KroneckerProduct>
#include <vector>

#include "verify/known_motions.hpp"

/// Small matrices of all kinds of patterns, for the tests of linear algebra.
namespace drape::verify::small_matrices {

using solver::SparseMatrix;

/// Sizes that are and are not multiples of what the kernels take at once.
inline constexpr int sizes[] = {1, 2, 3, 4, 7, 16, 400};

/// Random entries with this probability; some rows and columns stay empty.
inline SparseMatrix scattered(int n, double density, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1), chance(0, 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (chance(random) < density) entries.emplace_back(i, j, number(random));
  SparseMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

inline SparseMatrix diagonal(const Eigen::VectorXd& d) { return SparseMatrix(d.asDiagonal()); }

/// Symmetric positive definite: diagonally dominant by a little.
inline SparseMatrix definite(int n, double density, unsigned seed) {
  const SparseMatrix half = scattered(n, density, seed), whole = half + SparseMatrix(half.transpose());
  const SparseMatrix off = whole - diagonal(whole.diagonal());
  return off + diagonal(off.cwiseAbs() * Eigen::VectorXd::Ones(n) + Eigen::VectorXd::LinSpaced(n, 0.1, 1));
}

inline SparseMatrix tridiagonal(int n) {
  SparseMatrix A = -known_motions::row_of_springs(n, 3);
  return A + diagonal(Eigen::VectorXd::LinSpaced(n, 0.1, 1));
}

/// M − K of a sheet of springs: as in the stage, but for its edges.
inline SparseMatrix sheet(int nu, int nv) {
  const SparseMatrix one_u = diagonal(Eigen::VectorXd::Ones(nu)), one_v = diagonal(Eigen::VectorXd::Ones(nv));
  const SparseMatrix along = Eigen::kroneckerProduct(one_v, known_motions::row_of_springs(nu, 20));
  const SparseMatrix across = Eigen::kroneckerProduct(known_motions::row_of_springs(nv, 30), one_u);
  return diagonal(Eigen::VectorXd::Ones(nu * nv)) - along - across;
}

/// Matrices with all kinds of patterns.
inline std::vector<SparseMatrix> definite_matrices() {
  std::vector<SparseMatrix> all = {sheet(5, 4), sheet(20, 20), sheet(2, 9)};
  for (const int n : sizes)
    for (const double density : {0.1, 0.5}) all.push_back(definite(std::min(n, 60), density, 7));
  for (const int n : sizes) all.push_back(tridiagonal(n));
  return all;
}

}  // namespace drape::verify::small_matrices
