#include "verify/support/small_matrices.hpp"

#include <algorithm>
#include <random>
#include <unsupported/Eigen/KroneckerProduct>

namespace drape::verify::small_matrices {

SparseMatrix scattered(int n, double density, unsigned seed) {
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

SparseMatrix diagonal(const Eigen::VectorXd& d) { return SparseMatrix(d.asDiagonal()); }

SparseMatrix definite(int n, double density, unsigned seed) {
  const SparseMatrix half = scattered(n, density, seed), whole = half + SparseMatrix(half.transpose());
  const SparseMatrix off = whole - diagonal(whole.diagonal());
  return off + diagonal(off.cwiseAbs() * Eigen::VectorXd::Ones(n) + Eigen::VectorXd::LinSpaced(n, 0.1, 1));
}

SparseMatrix tridiagonal(int n) {
  SparseMatrix A = -known_motions::row_of_springs(n, 3);
  return A + diagonal(Eigen::VectorXd::LinSpaced(n, 0.1, 1));
}

SparseMatrix sheet(int nu, int nv) {
  const SparseMatrix one_u = diagonal(Eigen::VectorXd::Ones(nu)), one_v = diagonal(Eigen::VectorXd::Ones(nv));
  const SparseMatrix along = Eigen::kroneckerProduct(one_v, known_motions::row_of_springs(nu, 20));
  const SparseMatrix across = Eigen::kroneckerProduct(known_motions::row_of_springs(nv, 30), one_u);
  return diagonal(Eigen::VectorXd::Ones(nu * nv)) - along - across;
}

std::vector<SparseMatrix> definite_matrices() {
  std::vector<SparseMatrix> all = {sheet(5, 4), sheet(20, 20), sheet(2, 9)};
  for (const int n : sizes)
    for (const double density : {0.1, 0.5}) all.push_back(definite(std::min(n, 60), density, 7));
  for (const int n : sizes) all.push_back(tridiagonal(n));
  return all;
}

}  // namespace drape::verify::small_matrices
