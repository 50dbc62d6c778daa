// Conjugate gradients reach what they are asked for, in the coordinates that are free, and say so when they cannot.

#include "solver/linear/conjugate_gradients.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "verify/support/small_matrices.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::conjugate_gradients_test {
namespace {

using namespace small_matrices;
using namespace small_problems;
using solver::ConjugateGradients;
using solver::Counters;
using solver::Filter;
using solver::LinearResult;
using solver::LinearSolver;
using solver::Outcome;

/// Conjugate gradients with a factor of `factored`, which need not be the A of the system.
struct Solver {
  Counters work;
  Filter filter;
  ConjugateGradients cg;

  Solver(const LinearSolver& kind, const SparseMatrix& factored, const std::vector<Pin>& pins = {}, int max_iterations = 1000)
      : filter(Filter::partial(pins)), cg(kind.make(), max_iterations, work) {
    cg.analyse(factored);
    EXPECT_EQ(cg.factor(factored), Outcome::success);
  }

  LinearResult solve(const SparseMatrix& A, Vectors& r, Vectors& d, double target) { return cg.solve(A, filter, r, d, target); }
};

class ConjugateGradientsWith : public testing::TestWithParam<std::string> {
 protected:
  const LinearSolver& kind = solver::linear_solver(GetParam());
};
INSTANTIATE_TEST_SUITE_P(, ConjugateGradientsWith, testing::ValuesIn(names(solver::linear_solvers())),
                         [](const auto& test) { return test.param; });

TEST_P(ConjugateGradientsWith, ReachTheTarget) {
  for (const SparseMatrix& A : definite_matrices())
    for (const double tolerance : {1e-1, 1e-4, 1e-10}) {
      const int n = static_cast<int>(A.rows());
      const Vectors b = noise(n, 9);
      Vectors r = b, d = noise(n, 10);
      Solver solver(kind, A);
      ASSERT_EQ(solver.solve(A, r, d, tolerance * b.norm()).outcome, Outcome::success) << n;
      const Vectors residual = b - A * d;
      EXPECT_LE(residual.norm(), tolerance * b.norm() * (1 + 1e-3)) << n;
      EXPECT_LE(largest(residual - r), 1e-12) << n;
    }
}

int iterations(const LinearSolver& kind, const SparseMatrix& A) {
  Vectors r = noise(static_cast<int>(A.rows()), 9), d = r;
  Solver solver(kind, A);
  const LinearResult result = solver.solve(A, r, d, 1e-10 * r.norm());
  EXPECT_EQ(result.outcome, Outcome::success);
  EXPECT_EQ(solver.work.count("cg_iterations"), result.iterations);
  EXPECT_EQ(solver.work.count("preconditioner_applications"), result.iterations);
  EXPECT_EQ(solver.work.count("matrix_products"), result.iterations);
  return result.iterations;
}

TEST(ConjugateGradients, NeedOneIterationWithAnExactFactor) {
  for (const int n : sizes) EXPECT_EQ(iterations(solver::linear_solver("ic0"), tridiagonal(n)), 1) << n;
}

TEST(CompleteCholesky, SolvesByOneSubstitutionAlone) {
  const SparseMatrix A = sheet(20, 20);
  Vectors r = noise(400, 9), d = r;
  Solver solver(solver::linear_solver("cholesky"), A);
  EXPECT_EQ(solver.solve(A, r, d, 0).iterations, 0);
  EXPECT_EQ(solver.work.count("preconditioner_applications"), 1);
  EXPECT_EQ(solver.work.count("cg_iterations"), 0);
  EXPECT_EQ(solver.work.count("matrix_products"), 0);
}

TEST(CompleteCholesky, SeesNumbersThatAreNotFinite) {
  const SparseMatrix A = sheet(20, 20);
  Solver solver(solver::linear_solver("cholesky"), A);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
    for (const int particle : {0, 17, 399}) {
      Vectors r = noise(400, 9), d = r;
      r(particle, 1) = bad;
      EXPECT_EQ(solver.solve(A, r, d, 1e-10).outcome, Outcome::not_finite) << particle;
    }
}

TEST(ConjugateGradients, NeedMoreWithAnIncompleteOne) { EXPECT_GE(iterations(solver::linear_solver("ic0"), sheet(20, 20)), 5); }

TEST(ConjugateGradients, NeedFewerWithOneThatKeepsRowSums) {
  const SparseMatrix fine = diagonal(Eigen::VectorXd::Ones(3600)) + 20 * sheet(60, 60);
  EXPECT_LE(2 * iterations(solver::linear_solver("mic0"), fine), iterations(solver::linear_solver("ic0"), fine));
}

TEST(ConjugateGradients, RememberTheDirectionsBefore) {
  EXPECT_LE(iterations(solver::linear_solver("ic0"), sheet(20, 20)), 50) << "steepest descent needs 175";
}

TEST_P(ConjugateGradientsWith, SolveInTheFreeCoordinates) {
  const std::vector<Pin> pins = {{.particle = 0, .held = solver::axes(true, false, false)},
                                 {.particle = 3, .held = solver::axes(false, true, true)},
                                 {.particle = 7, .held = solver::axes(true, false, true)},
                                 {.particle = 8, .held = solver::axes(false, false, true)},
                                 {.particle = 19, .held = solver::axes(true, true, false)}};
  const int n = 20;
  const SparseMatrix A = sheet(5, 4);
  Vectors b = noise(n, 9);
  filter(pins, b);
  Vectors r = b, d(n, 3);
  Solver solver(kind, A, pins);
  ASSERT_EQ(solver.solve(A, r, d, 1e-12).outcome, Outcome::success);

  Eigen::MatrixXd dense = threefold(A);
  Eigen::VectorXd right = Eigen::VectorXd::Map(b.data(), 3 * n);
  for (const Pin& pin : pins)
    for (int c = 0; c < 3; ++c) {
      const int k = 3 * pin.particle + c;
      if (!pin.fixed(c)) continue;
      dense.row(k).setZero(), dense.col(k).setZero();
      dense(k, k) = 1;
    }
  const Eigen::VectorXd expected = dense.llt().solve(right);
  EXPECT_LE(largest(Eigen::VectorXd::Map(d.data(), 3 * n) - expected), 1e-11);
  r = d;
  filter(pins, r);
  EXPECT_EQ(r, d);
}

TEST_P(ConjugateGradientsWith, TellHowTheyFailed) {
  const SparseMatrix A = definite(400, 0.01, 7), indefinite = A - 3 * diagonal(Eigen::VectorXd::Ones(400));
  const std::vector<Pin> pins = {
      {.particle = 5, .held = solver::axes(true, false, false)}};  // or a direct solver would not iterate
  Vectors b = noise(400, 9);
  filter(pins, b);
  Vectors r = b, d(400, 3);
  Solver definite(kind, A, pins);
  EXPECT_EQ(definite.solve(indefinite, r, d, 1e-10).outcome, Outcome::breakdown);
  r = b;
  r(17, 1) = std::nan("");
  EXPECT_EQ(definite.solve(A, r, d, 1e-10).outcome, Outcome::not_finite);
  SparseMatrix not_finite = A;
  not_finite.coeffRef(7, 7) = std::nan("");
  r = b;
  EXPECT_EQ(definite.solve(not_finite, r, d, 1e-10).outcome, Outcome::not_finite);
  Solver hurried(solver::linear_solver("ic0"), A, {}, 3);
  r = b;
  const LinearResult result = hurried.solve(A, r, d, 1e-10);
  EXPECT_EQ(result.outcome, Outcome::not_converged);
  EXPECT_EQ(result.iterations, 3);
}

TEST_P(ConjugateGradientsWith, DoNothingWhereThereIsNothingToSolve) {
  const SparseMatrix A = sheet(5, 4);
  Vectors r = Vectors::Zero(20, 3), d = noise(20, 1);
  Solver solver(kind, A);
  const LinearResult result = solver.solve(A, r, d, 0);
  EXPECT_EQ(result.outcome, Outcome::success);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(largest(d), 0);
}

}  // namespace
}  // namespace drape::verify::conjugate_gradients_test
