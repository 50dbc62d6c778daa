// Quadrature, interpolation and differentiation are exact for polynomials of their degree.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reference/exact/collocation.hpp"
#include "reference/exact/polynomials.hpp"
#include "verify/support/convergence.hpp"

namespace drape::verify::exact_polynomials_test {
namespace {

using namespace reference;

TEST(Gauss, IsExactUpToTwiceTheNumberOfPoints) {
  for (const int n : {1, 2, 5, 6}) {
    const Quadrature rule = gauss(n);
    const auto error = [&](int p) { return (rule.weights.array() * rule.points.array().pow(p)).sum() - 1.0 / (p + 1); };
    for (int p = 0; p < 2 * n; ++p) EXPECT_NEAR(error(p), 0, 1e-14) << n << ", " << p;
    EXPECT_GT(std::abs(error(2 * n)), 1e-8) << n;
  }
}

TEST(Polynomials, AreInterpolatedAndDifferentiatedExactly) {
  const Eigen::VectorXd nodes = chebyshev(7), points = Eigen::VectorXd::LinSpaced(15, 0, 1);
  const Eigen::VectorXd values = nodes.array().pow(7) - nodes.array();
  EXPECT_LE((interpolation(nodes, points) * values - (points.array().pow(7) - points.array()).matrix()).norm(), 1e-14);
  EXPECT_LE((differentiation(nodes) * values - (7 * nodes.array().pow(6) - 1).matrix()).norm(), 1e-12);
}

TEST(GradedBreaks, ShrinkTowardsBothEnds) {
  const Eigen::VectorXd breaks = graded_breaks(3, 0.25, 2);
  ASSERT_EQ(breaks.size(), 13);
  const Eigen::VectorXd expected =
      (Eigen::VectorXd(7) << 0, 1 / 64.0, 1 / 32.0, 5 / 64.0, 1 / 8.0, 5 / 16.0, 1 / 2.0).finished();
  EXPECT_LE((breaks.head(7) - expected).norm(), 1e-15);
  EXPECT_LE((breaks + breaks.reverse() - Eigen::VectorXd::Ones(13)).norm(), 1e-15);
}

/// y'' = e^(2y) with the ends of y = −log(1 + X).
BoundaryValueProblem nonlinear_problem() {
  using Vector = BoundaryValueProblem::Vector;
  return {[](double, const Vector& y) -> Vector {
            return Vector{{y[1], std::exp(2.0 * y[0])}};
          },
          [](const Vector& left, const Vector& right) -> Vector {
            return Vector{{left[0], right[0] + std::log(2.0)}};
          }};
}

TEST(Collocation, HasTheOrderOfItsDegree) {
  Convergence inside, at_ends;
  for (const int pieces : {16, 32, 64, 128}) {
    PiecewisePolynomial y(Eigen::VectorXd::LinSpaced(pieces + 1, 0, 1), 2,
                          [](double X) -> Eigen::VectorXd { return Eigen::Vector2d(-X / 2, -0.5); });
    collocate(nonlinear_problem(), y);
    double error = 0, end_error = 0;
    for (const double X : Eigen::VectorXd::LinSpaced(641, 0, 1)) error = std::max(error, std::abs(y(X)[0] + std::log1p(X)));
    for (const double X : y.breaks()) end_error = std::max(end_error, std::abs(y(X)[0] + std::log1p(X)));
    inside.steps.push_back(1.0 / pieces);
    at_ends.steps.push_back(1.0 / pieces);
    inside.errors.push_back(error);
    at_ends.errors.push_back(end_error);
  }
  EXPECT_TRUE(has_order(inside, 3));
  EXPECT_TRUE(has_order(at_ends, 4));
}

TEST(Collocation, SaysWhenThereIsNoSolution) {
  using Vector = BoundaryValueProblem::Vector;
  const BoundaryValueProblem problem{[](double, const Vector& y) -> Vector { return 10.0 + y.array() * y.array(); },
                                     [](const Vector& left, const Vector&) -> Vector { return left; }};  // y = √10 tan(√10 X)
  PiecewisePolynomial y(Eigen::VectorXd::LinSpaced(5, 0, 1), 4,
                        [](double) -> Eigen::VectorXd { return Eigen::VectorXd::Zero(1); });
  EXPECT_THROW(collocate(problem, y), std::runtime_error);
}

}  // namespace
}  // namespace drape::verify::exact_polynomials_test
