// Kernels and preconditioners against dense linear algebra.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "solver/linear/kernels.hpp"
#include "solver/linear/preconditioner.hpp"
#include "verify/support/small_matrices.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::linear_algebra_test {
namespace {

using namespace small_matrices;
using namespace small_problems;
using solver::LinearSolver;
using solver::Outcome;
using solver::Preconditioner;

constexpr double round_off = 1e-14;

double dot(const Vectors& a, const Vectors& b) { return a.cwiseProduct(b).sum(); }
void expect_dense_product(const SparseMatrix& A, const std::string& what) {
  const int n = static_cast<int>(A.rows());
  const Vectors x = noise(n, 5);
  Vectors y = noise(n, 6);  // what was there before must not matter
  const double xy = solver::multiply(A, x, y);
  const Eigen::MatrixXd expected = Eigen::MatrixXd(A) * x;
  EXPECT_LE(largest(y - expected), round_off * n) << what << ", n = " << n;
  EXPECT_NEAR(xy, dot(x, expected), round_off * n * n) << what << ", n = " << n;
}

TEST(Multiply, IsTheDenseProduct) {
  for (const int n : sizes) {
    expect_dense_product(scattered(n, 0.4, 1), "scattered");
    expect_dense_product(scattered(n, 2.0 / n, 2), "with empty rows");
    expect_dense_product(SparseMatrix(n, n), "empty");
    expect_dense_product(tridiagonal(n), "tridiagonal");
    SparseMatrix last_row(n, n), last_column(n, n), corner(n, n);
    for (int i = 0; i < n; ++i) last_row.insert(n - 1, i) = i + 1, last_column.insert(i, n - 1) = i + 1;
    corner.insert(0, n - 1) = 2;
    for (SparseMatrix* A : {&last_row, &last_column, &corner}) A->makeCompressed();
    expect_dense_product(last_row, "last row");
    expect_dense_product(last_column, "last column");
    expect_dense_product(corner, "corner");
  }
}

TEST(Advance, IsTheDenseUpdate) {
  for (const int n : sizes) {
    const Vectors p = noise(n, 1), q = noise(n, 2), x0 = noise(n, 3), r0 = noise(n, 4);
    Vectors x = x0, r = r0;
    const double rr = solver::advance(0.7, p, q, x, r);
    EXPECT_LE(largest(x - (x0 + 0.7 * p)), round_off) << n;
    EXPECT_LE(largest(r - (r0 - 0.7 * q)), round_off) << n;
    EXPECT_NEAR(rr, (r0 - 0.7 * q).squaredNorm(), round_off * n) << n;
  }
}

std::unique_ptr<Preconditioner> prepared(const LinearSolver& kind, const SparseMatrix& A) {
  auto preconditioner = kind.make();
  preconditioner->analyse(A);
  EXPECT_EQ(preconditioner->factor(A), Outcome::success);
  return preconditioner;
}

/// What the preconditioner stands for: the dense inverse of its application.
Eigen::MatrixXd stands_for(Preconditioner& preconditioner, int n) {
  Eigen::MatrixXd inverse(n, n);
  Vectors r(n, 3), z(n, 3);
  for (int j = 0; j < n; ++j) {
    r.setZero();
    r(j, j % 3) = 1;  // one coordinate at a time: they must not mix
    preconditioner.apply(r, z);
    inverse.col(j) = z.col(j % 3);
    z.col(j % 3).setZero();
    EXPECT_EQ(largest(z), 0);
  }
  return inverse.inverse();
}

class PreconditionerOf : public testing::TestWithParam<std::string> {
 protected:
  const LinearSolver& kind = solver::linear_solver(GetParam());
};
INSTANTIATE_TEST_SUITE_P(, PreconditionerOf, testing::ValuesIn(names(solver::linear_solvers())),
                         [](const auto& test) { return test.param; });

TEST_P(PreconditionerOf, IsSymmetricPositiveDefinite) {
  for (const SparseMatrix& A : definite_matrices()) {
    const Eigen::MatrixXd P = stands_for(*prepared(kind, A), static_cast<int>(A.rows()));
    EXPECT_LE(largest(P - P.transpose()), 1e-11 * largest(P)) << A.rows();
    EXPECT_EQ(P.llt().info(), Eigen::Success) << A.rows();
  }
}

TEST_P(PreconditionerOf, ReturnsTheScalarProduct) {
  for (const SparseMatrix& A : definite_matrices()) {
    const int n = static_cast<int>(A.rows());
    const Vectors r = noise(n, 8);
    Vectors z(n, 3);
    const double rz = prepared(kind, A)->apply(r, z);
    EXPECT_NEAR(rz, dot(r, z), 1e-13 * std::abs(rz)) << n;
  }
}

TEST_P(PreconditionerOf, DoesNotRememberWhatItWasAppliedTo) {
  const SparseMatrix A = sheet(5, 4);
  const auto preconditioner = prepared(kind, A);
  Vectors first(20, 3), other(20, 3), second(20, 3);
  preconditioner->apply(noise(20, 1), first);
  preconditioner->apply(1e3 * noise(20, 2), other);
  preconditioner->apply(noise(20, 1), second);
  EXPECT_EQ(first, second);
}

TEST_P(PreconditionerOf, FollowsNewValuesAlsoAfterABreakdown) {
  if (GetParam() == "cg") GTEST_SKIP() << "no preconditioner, so no values";
  const SparseMatrix A = sheet(5, 4), indefinite = A - 60 * diagonal(Eigen::VectorXd::Ones(20));
  const auto preconditioner = prepared(kind, A);
  EXPECT_EQ(preconditioner->factor(indefinite), Outcome::breakdown);
  EXPECT_EQ(preconditioner->factor(4 * A), Outcome::success);
  Vectors z(20, 3), expected(20, 3);
  preconditioner->apply(noise(20, 1), z);
  prepared(kind, A)->apply(noise(20, 1), expected);
  EXPECT_LE(largest(4 * z - expected), 1e-14);
}

TEST_P(PreconditionerOf, BreaksDownOnEveryMatrixThatIsNotDefinite) {
  if (GetParam() == "cg" || GetParam() == "jacobi") GTEST_SKIP() << "a diagonal shows it of some matrices only";
  Eigen::Matrix3d semidefinite = 3 * Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Ones();
  Eigen::Matrix3d indefinite = Eigen::Matrix3d::Identity() + 2 * Eigen::Matrix3d::Ones() - 2 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d negative = -Eigen::Matrix3d::Identity();
  semidefinite(2, 2) = 0;
  for (const Eigen::Matrix3d& A : {semidefinite, indefinite, negative}) {
    const SparseMatrix sparse = A.sparseView(1, -1);  // zeros are entries
    const auto preconditioner = kind.make();
    preconditioner->analyse(sparse);
    EXPECT_EQ(preconditioner->factor(sparse), Outcome::breakdown) << A;
  }
}

/// P = A where A has entries, and its triangular factor has entries nowhere else: only IC(0) is both.
TEST(IncompleteCholesky, IsTheMatrixOnItsPattern) {
  for (const SparseMatrix& A : definite_matrices()) {
    const int n = static_cast<int>(A.rows());
    const Eigen::MatrixXd P = stands_for(*prepared(solver::linear_solver("ic0"), A), n), L = P.llt().matrixL();
    const Eigen::MatrixXd pattern = Eigen::MatrixXd(A).unaryExpr([](double a) { return a == 0 ? 0.0 : 1.0; });
    EXPECT_LE(largest(pattern.cwiseProduct(P - A)), 1e-11 * largest(A)) << n;
    const Eigen::MatrixXd elsewhere = (Eigen::MatrixXd::Ones(n, n) - pattern).triangularView<Eigen::StrictlyLower>();
    EXPECT_LE(largest(elsewhere.cwiseProduct(L)), 1e-11 * largest(L)) << n;
  }
}

TEST(IncompleteCholesky, IsNotTheMatrixWhereFactorsFillIn) {
  const SparseMatrix A = sheet(5, 4);
  EXPECT_GE(largest(stands_for(*prepared(solver::linear_solver("ic0"), A), 20) - A), 1);
}

/// As the incomplete factor except for its diagonal, which gives back what was dropped, all but a thousandth.
TEST(ModifiedIncompleteCholesky, KeepsRowSums) {
  const SparseMatrix A = sheet(5, 4);
  const auto error = [&](const char* name) -> Eigen::MatrixXd {
    return stands_for(*prepared(solver::linear_solver(name), A), 20) - A;
  };
  const Eigen::MatrixXd modified = error("mic0"), plain = error("ic0");
  const Eigen::VectorXd sums = modified.rowwise().sum(), dropped = modified.cwiseAbs().rowwise().sum() / 2;
  EXPECT_LE(largest(sums), 1.1e-3 * largest(dropped));
  EXPECT_GE(largest(sums), 0.9e-3 * dropped.minCoeff());
  EXPECT_GE(largest(plain.rowwise().sum()), 0.5 * largest(plain));
  for (int i = 0; i < 20; ++i)
    for (SparseMatrix::InnerIterator a(A, i); a; ++a)
      EXPECT_NEAR(modified(i, a.col()), 0, a.col() == i ? INFINITY : 1e-11) << i << ' ' << a.col();
}

TEST(CompleteCholesky, IsTheMatrix) {
  for (const SparseMatrix& A : definite_matrices()) {
    const int n = static_cast<int>(A.rows());
    const Vectors r = noise(n, 3);
    Vectors z(n, 3);
    prepared(solver::linear_solver("cholesky"), A)->apply(r, z);
    EXPECT_LE(largest(A * z - r), 1e-14 * (largest(A) * largest(z) + largest(r))) << n;
  }
}

TEST(Factor, SeesNumbersThatAreNotFinite) {
  SparseMatrix A = sheet(5, 4);
  A.coeffRef(7, 7) = std::nan("");
  const auto preconditioner = solver::make_incomplete_cholesky();
  preconditioner->analyse(A);
  EXPECT_EQ(preconditioner->factor(A), Outcome::not_finite);
}

}  // namespace
}  // namespace drape::verify::linear_algebra_test
