// Multigrid and the five-point stars it works on: found where they are, symmetric, and as fast on fine grids as on coarse ones.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "solver/linear/coarse_grid.hpp"
#include "solver/linear/conjugate_gradients.hpp"
#include "verify/support/small_matrices.hpp"
#include "verify/support/small_problems.hpp"
#include "verify/support/threads.hpp"

namespace drape::verify::multigrid_test {
namespace {

using namespace small_matrices;
using namespace small_problems;
using solver::FivePoint;
using solver::Outcome;

double dot(const Vectors& a, const Vectors& b) { return a.cwiseProduct(b).sum(); }

/// 1 + stiff · sheet, without what couples to these particles.
SparseMatrix pinned_sheet(int nu, int nv, double stiff, const std::vector<int>& pins) {
  SparseMatrix A = diagonal(Eigen::VectorXd::Ones(nu * nv)) + stiff * sheet(nu, nv);
  std::vector<bool> gone(nu * nv, false);
  for (const int i : pins) gone[i] = true;
  A.prune([&](int i, int j, double) { return i == j || (!gone[i] && !gone[j]); });
  return A;
}

std::vector<int> line(int n) {
  std::vector<int> first(n);
  for (int i = 0; i < n; ++i) first[i] = i;
  return first;
}

std::vector<int> scattered_pins(int n, int count) {
  std::mt19937 random(3);
  std::vector<int> pins(count);
  for (int& i : pins) i = static_cast<int>(random() % n);
  return pins;
}

/// Sheets of all kinds of shapes, above the size that is solved directly.
std::vector<SparseMatrix> sheets() {
  return {pinned_sheet(40, 40, 1e3, {}),       pinned_sheet(61, 38, 1e4, line(61)),
          pinned_sheet(50, 41, 1e2, {0, 49}),  pinned_sheet(37, 60, 1e3, scattered_pins(37 * 60, 100)),
          pinned_sheet(2, 700, 1e3, {0, 1}),   pinned_sheet(3, 501, 1e3, {}),
          pinned_sheet(1500, 1, 1e3, {0}),     pinned_sheet(700, 2, 1e3, line(700)),
          pinned_sheet(33, 65, 1e-2, line(33))};
}

TEST(FivePointStar, IsFoundInEveryShapeOfSheet) {
  for (const auto& [nu, nv] : {std::pair{5, 4}, {2, 9}, {9, 2}, {3, 3}, {20, 20}}) {
    const SparseMatrix A = pinned_sheet(nu, nv, 7, {1});
    const auto star = solver::five_point(A);
    ASSERT_TRUE(star) << nu << ' ' << nv;
    EXPECT_EQ(star->nu, nu);
    EXPECT_EQ(star->nv, nv);
    EXPECT_EQ(largest(solver::sparse(*star) - A), 0);
  }
  for (const int n : sizes) EXPECT_EQ(solver::five_point(tridiagonal(n))->nu, n);
}

TEST(FivePointStar, IsNotFoundWhereThereIsNone) {
  SparseMatrix around = sheet(5, 4), one_sided = sheet(5, 4);
  for (const auto& [i, j] : {std::pair{4, 5}, {5, 4}})
    around.coeffRef(i, j) = -1;  // from the end of a line to the beginning of the next
  one_sided.coeffRef(3, 4) *= 2;
  for (const SparseMatrix& A : {around, one_sided, definite(60, 0.1, 7), SparseMatrix(sheet(5, 4) * sheet(5, 4))})
    EXPECT_FALSE(solver::five_point(A));
}

TEST(FivePointStar, SharesEqualLines) {
  EXPECT_EQ(solver::five_point(sheet(20, 30))->nodes.size(), 3 * 20);
  EXPECT_EQ(solver::five_point(pinned_sheet(20, 30, 7, {205}))->nodes.size(), (3 + 4) * 20);
}

TEST(FivePointStar, MultipliesAsTheMatrix) {
  for (const auto& [nu, nv] : {std::pair{1, 1}, {2, 1}, {7, 1}, {1, 7}, {2, 2}, {5, 3}, {4, 9}}) {
    const int n = nu * nv;
    const SparseMatrix A = pinned_sheet(nu, nv, 7, {});
    const Vectors z = noise(n, 1), before = noise(n, 2);
    Vectors p = before, q(n, 3);
    const double pq = update_direction(*solver::five_point(A), z, 0.3, p, q);
    const Vectors direction = z + 0.3 * before, product = A * direction;
    EXPECT_LE(largest(p - direction), 1e-15) << n;
    EXPECT_LE(largest(q - product), 1e-12) << n;
    EXPECT_NEAR(pq, dot(direction, product), 1e-11 * n) << n;
    p.setConstant(std::nan(""));
    update_direction(*solver::five_point(A), z, 0, p, q);
    EXPECT_EQ(p, z) << "the first direction knows no other";
  }
}

TEST(Multigrid, IsSymmetricPositiveDefinite) {
  for (const SparseMatrix& A : sheets()) {
    const int n = static_cast<int>(A.rows());
    const auto cycle = solver::make_multigrid();
    cycle->analyse(A);
    ASSERT_EQ(cycle->factor(A), Outcome::success);
    EXPECT_FALSE(cycle->exact());
    const Vectors r = noise(n, 1), s = noise(n, 2);
    Vectors z = Vectors::Constant(n, 3, std::nan("")), w = z;  // whatever was there
    const double rz = cycle->apply(r, z), sw = cycle->apply(s, w);
    EXPECT_NEAR(rz, dot(r, z), 1e-13 * std::abs(rz)) << n;
    EXPECT_NEAR(dot(s, z), dot(r, w), 1e-12 * std::sqrt(rz * sw)) << n;
    EXPECT_GT(rz, 0) << n;
  }
}

int iterations(const SparseMatrix& A) {
  solver::Counters work;
  solver::ConjugateGradients cg(solver::make_multigrid(), 100, work);
  cg.analyse(A);
  EXPECT_EQ(cg.factor(A), Outcome::success);
  const Vectors b = noise(static_cast<int>(A.rows()), 9);
  Vectors r = b, d = b;
  const solver::LinearResult result = cg.solve(A, {}, r, d, 1e-8 * b.norm());
  EXPECT_EQ(result.outcome, Outcome::success);
  EXPECT_LE(Vectors(b - A * d).norm(), 1.1e-8 * b.norm());
  return result.iterations;
}

TEST(Multigrid, NeedsFewIterationsOnEverySheet) {
  for (const SparseMatrix& A : sheets()) EXPECT_LE(iterations(A), 12) << A.rows();
}

TEST(Multigrid, NeedsNoMoreOnFineSheets) {
  for (const int n : {127, 128, 129}) EXPECT_LE(iterations(pinned_sheet(n, n, 1e4, line(n))), 10) << n;
}

TEST(Multigrid, CoarsensAlongTheStrongerSpringsOnly) {
  const auto coarsened = [](double across) {
    SparseMatrix A = diagonal(Eigen::VectorXd::Ones(1600)) + 1e3 * sheet(40, 40);
    for (int i = 0; i < 1600; ++i)
      for (SparseMatrix::InnerIterator a(A, i); a; ++a)
        if (std::abs(a.col() - i) == 40) {
          A.coeffRef(i, i) += (1 - across) * a.value();
          a.valueRef() *= across;
        }
    const solver::CoarseGrid coarse(*solver::five_point(A));
    EXPECT_LE(iterations(A), 12) << across;
    return std::pair{coarse.A.nu, coarse.A.nv};
  };
  EXPECT_EQ(coarsened(1), std::pair(21, 21));
  EXPECT_EQ(coarsened(1e-3), std::pair(21, 40));
  EXPECT_EQ(coarsened(1e3), std::pair(40, 21));
}

// --- Threads -----------------------------------------------------------------------------------------------------------------

TEST(ThreadsOfLargeGrids, ChangeNothing) {
  for (const auto& [nu, nv] : {std::pair{201, 206}, {1000, 49}, {400, 101}, {202, 205}}) {
    const int n = nu * nv;
    const SparseMatrix A = pinned_sheet(nu, nv, 1e2, line(nu));
    const auto star = solver::five_point(A);
    const auto cycle = solver::make_multigrid();
    ASSERT_EQ(cycle->factor(A), Outcome::success);
    const Vectors r = noise(n, 1);
    std::vector<Vectors> p, q, z;
    std::vector<std::array<double, 3>> sums;
    for (const int threads : {1, 2, 3, 5}) {
      const Threads allowed(threads);
      EXPECT_EQ(base::threads_for(n), threads);
      p.push_back(noise(n, 2)), q.emplace_back(n, 3), z.emplace_back(n, 3);
      const double pq = update_direction(*star, r, 0.3, p.back(), q.back()), rz = cycle->apply(r, z.back());
      EXPECT_NEAR(pq, dot(p.back(), q.back()), 1e-12 * pq);
      EXPECT_NEAR(rz, dot(r, z.back()), 1e-12 * rz);
      Vectors x = noise(n, 3), y = r;
      const double rr = solver::advance(0.7, p.back(), q.back(), x, y), expected = (r - 0.7 * q.back()).squaredNorm();
      EXPECT_NEAR(rr, expected, 1e-12 * expected);
      sums.push_back({pq, rz, rr});
      EXPECT_EQ(p.back(), p.front()) << threads << " threads";
      EXPECT_EQ(q.back(), q.front()) << threads << " threads";
      EXPECT_EQ(z.back(), z.front()) << threads << " threads";
      EXPECT_EQ(sums.back(), sums.front()) << threads << " threads";
    }
  }
}

TEST(ThreadsOfLargeGrids, AreOneUnlessAskedForAndForSmallGrids) {
  EXPECT_EQ(base::threads_for(1000000), 1);
  const Threads allowed(2);
  EXPECT_EQ(base::threads_for(1000000), 2);
  EXPECT_EQ(base::threads_for(10000), 1);
  EXPECT_THROW(base::use_threads(0), std::invalid_argument);
  EXPECT_THROW(base::use_threads(1000), std::invalid_argument);
}

// --- The choice --------------------------------------------------------------------------------------------------------------

/// What `auto` takes for a matrix, and why.
std::string chosen(const SparseMatrix& A) {
  const auto automatic = solver::make_automatic();
  automatic->analyse(A);
  EXPECT_EQ(automatic->factor(A), Outcome::success);
  return fmt::format("{}: {}", automatic->name(), automatic->reason());
}

/// The same with a spring to a particle far away.
SparseMatrix sewn(SparseMatrix A) {
  const int far = static_cast<int>(A.rows()) - 600;
  for (const auto& [i, j] : {std::pair{200, far}, {far, 200}}) A.coeffRef(i, j) = -1;
  A.makeCompressed();
  return A;
}

TEST(AutomaticChoice, GoesBySizeStiffnessAndPattern) {
  EXPECT_EQ(chosen(sheet(20, 20)), "cholesky: small");
  const SparseMatrix large = pinned_sheet(160, 160, 1e3, line(160));
  EXPECT_EQ(chosen(large), "multigrid: grid");
  EXPECT_EQ(chosen(diagonal(1e6 * Eigen::VectorXd::Ones(160 * 160)) + large), "mic0: soft");
  EXPECT_EQ(chosen(sewn(large)), "cholesky: no-grid");
  EXPECT_EQ(chosen(sewn(pinned_sheet(460, 460, 1e3, {}))), "mic0: large");
}

TEST(AutomaticChoice, IsCountedAndMadeAnewForNewValues) {
  solver::Counters work;
  solver::ConjugateGradients cg(solver::make_automatic(), 100, work);
  const SparseMatrix stiff = pinned_sheet(160, 160, 1e3, {}), soft = diagonal(1e6 * Eigen::VectorXd::Ones(160 * 160)) + stiff;
  cg.analyse(stiff);
  for (const SparseMatrix* A : {&stiff, &soft, &soft}) EXPECT_EQ(cg.factor(*A), Outcome::success);
  EXPECT_EQ(work.count("linear_solver/multigrid"), 1);
  EXPECT_EQ(work.count("linear_solver/mic0"), 2);
  EXPECT_EQ(work.count("linear_solver/auto"), 0);
  EXPECT_EQ(work.count("linear_choice/grid"), 1);
  EXPECT_EQ(work.count("linear_choice/soft"), 2);
  EXPECT_EQ(work.count("linear_choice/small"), 0);
}

}  // namespace
}  // namespace drape::verify::multigrid_test
