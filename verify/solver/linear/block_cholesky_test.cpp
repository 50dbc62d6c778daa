// The complete factor of matrices of 3 × 3 blocks: against dense factors, on graphs of one and of many parts.

#include "solver/linear/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <utility>
#include <vector>

#include "verify/support/small_matrices.hpp"
#include "verify/support/threads.hpp"

namespace drape::verify::block_cholesky_test {
namespace {

using solver::BlockCholesky;
using solver::SparseMatrix;
using solver::Vectors;

/// The upper triangle of G ⊗ I + noise in the blocks of G, which its diagonal dominates; some coordinates are coupled to
/// nothing, as pinned ones are.
SparseMatrix blocks_of(const SparseMatrix& G, unsigned seed) {
  std::srand(seed);
  std::vector<Eigen::Triplet<double>> entries;
  const auto pinned = [](int i) { return i % 11 == 5; };
  for (int i = 0; i < G.rows(); ++i)
    for (SparseMatrix::InnerIterator g(G, i); g; ++g) {
      if (g.col() < i) continue;
      const Eigen::Matrix3d noise = 0.1 * Eigen::Matrix3d::Random();
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const int row = 3 * i + a, column = 3 * static_cast<int>(g.col()) + b;
          if (column < row || (row != column && (pinned(row) || pinned(column)))) continue;
          entries.emplace_back(row, column, row == column ? 2 + g.value() : noise(a, b) * g.value());
        }
    }
  SparseMatrix A(3 * G.rows(), 3 * G.rows());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

Eigen::MatrixXd dense(const SparseMatrix& A) { return Eigen::MatrixXd(A).selfadjointView<Eigen::Upper>(); }

Vectors solution(const BlockCholesky& factor, const Vectors& r) {
  Vectors d;
  factor.solve(r, d);
  return d;
}

TEST(BlockCholesky, SolvesAsADenseFactor) {
  for (const SparseMatrix& G : small_matrices::definite_matrices()) {
    const SparseMatrix A = blocks_of(G, 1);
    BlockCholesky factor(A);
    for (const double scale : {1.0, 3.0}) {  // the second with the order of the first
      ASSERT_TRUE(factor.factor(scale * A));
      const Vectors r = Vectors::Random(G.rows(), 3), d = solution(factor, r);
      const Eigen::VectorXd expected = dense(scale * A).llt().solve(Eigen::VectorXd::Map(r.data(), r.size()));
      EXPECT_LE((Eigen::VectorXd::Map(d.data(), d.size()) - expected).norm(), 1e-12 * expected.norm()) << G.rows() << " blocks";
    }
  }
}

TEST(BlockCholesky, KnowsMatricesThatAreNotDefinite) {
  SparseMatrix A = blocks_of(small_matrices::sheet(20, 20), 2);
  BlockCholesky factor(A);
  const Vectors r = Vectors::Random(400, 3);
  ASSERT_TRUE(factor.factor(A));
  const Vectors before = solution(factor, r);
  for (const int i : {0, 599, 1199}) {
    SparseMatrix indefinite = A;
    indefinite.coeffRef(i, i) = -1;
    EXPECT_FALSE(factor.factor(indefinite)) << "coordinate " << i;
  }
  ASSERT_TRUE(factor.factor(A));
  EXPECT_EQ(solution(factor, r), before) << "what failed leaves nothing behind";
}

/// Fronts of several tiles, and branches for several threads.
TEST(BlockCholesky, IsTheSameForAnyNumberOfThreads) {
  const SparseMatrix A = blocks_of(small_matrices::sheet(70, 60), 3);
  const Vectors r = Vectors::Random(4200, 3);
  std::vector<Vectors> found;
  for (const int threads : {1, 2, 3, 7}) {
    const Threads allowed(threads);
    BlockCholesky factor(A);  // takes as many as are allowed now
    ASSERT_TRUE(factor.factor(A));
    found.push_back(solution(factor, r));
    EXPECT_EQ(found.back(), found.front()) << threads << " threads";
  }
  const Eigen::VectorXd d = Eigen::VectorXd::Map(found[0].data(), r.size());
  EXPECT_LE((A.selfadjointView<Eigen::Upper>() * d - Eigen::VectorXd::Map(r.data(), r.size())).norm(), 1e-13 * r.norm());
}

}  // namespace
}  // namespace drape::verify::block_cholesky_test
