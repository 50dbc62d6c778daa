// The tableaus of Rosenbrock methods fulfil the conditions of their order, as W-methods those for any matrix; and the systems
// of their stages are solved.

#include "solver/methods/rosenbrock.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "solver/stage/stage_solver.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::rosenbrock_test {
namespace {

using namespace small_problems;
using solver::LinearisedSystem;
using solver::Outcome;
using solver::RosenbrockTableau;

/// A tableau as matrices, of one order and its weights.
struct Coefficients {
  Eigen::MatrixXd a, gamma;
  Eigen::VectorXd b;

  Coefficients(const RosenbrockTableau& T, const RosenbrockTableau::Row& weights)
      : a(matrix(T.a, T.stages)), gamma(matrix(T.gammas, T.stages)), b(Eigen::VectorXd::Map(weights.data(), T.stages)) {
    gamma.diagonal().setConstant(T.gamma);
  }
  static Eigen::MatrixXd matrix(const std::array<RosenbrockTableau::Row, RosenbrockTableau::most>& rows, int n) {
    Eigen::MatrixXd A(n, n);
    for (int i = 0; i < n; ++i) A.row(i) = Eigen::RowVectorXd::Map(rows[i].data(), n);
    return A;
  }

  /// The largest residual of the conditions of an order, up to 3   [Hairer, Wanner 1996, IV.7].
  double residual(int order) const {
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(b.size()), alpha = a * one;
    const Eigen::MatrixXd beta = a + gamma;
    double worst = std::abs(b.sum() - 1);
    const auto condition = [&](double value, double wanted) { worst = std::max(worst, std::abs(value - wanted)); };
    if (order >= 2) condition(b.dot(beta * one), 1.0 / 2);
    if (order >= 3) condition(b.dot(alpha.cwiseAbs2()), 1.0 / 3);
    if (order >= 3) condition(b.dot(beta * beta * one), 1.0 / 6);
    return worst;
  }

  /// The same of those that do not presume that the matrix is the Jacobian.
  double residual_with_any_matrix(int order) const {
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(b.size());
    double worst = residual(order);
    const auto vanishes = [&](double value) { worst = std::max(worst, std::abs(value)); };
    if (order >= 2) vanishes(b.dot(gamma * one));
    if (order >= 3)
      for (const Eigen::MatrixXd& product :
           {Eigen::MatrixXd(a * gamma), Eigen::MatrixXd(gamma * a), Eigen::MatrixXd(gamma * gamma)})
        vanishes(b.dot(product * one));
    return worst;
  }
};

TEST(RosenbrockTableaus, FulfilTheConditionsOfTheirOrderAndOfNoHigher) {
  for (const RosenbrockTableau& T : solver::rosenbrock_tableaus()) {
    const Coefficients method(T, T.b), embedded(T, T.b_hat);
    EXPECT_LE(method.residual(T.order), 1e-14) << T.name;
    EXPECT_TRUE(T.order == 3 || method.residual(3) >= 1e-3) << T.name;
    EXPECT_LE(embedded.residual(T.order - 1), 1e-14) << T.name;
    EXPECT_GE(embedded.residual(T.order), 1e-3) << T.name;
    EXPECT_EQ(solver::method(T.name).order, T.order);
  }
}

TEST(RosenbrockTableaus, FulfilTheConditionsForAnyMatrixIfTheyAreOfWMethods) {
  for (const RosenbrockTableau& T : solver::rosenbrock_tableaus()) {
    const double residual = Coefficients(T, T.b).residual_with_any_matrix(T.order);
    if (T.w_method)
      EXPECT_LE(residual, 1e-14) << T.name;
    else
      EXPECT_GE(residual, 1e-2) << T.name;
  }
}

/// With unsymmetric derivatives, beside which those of the problem are symmetric.
Problem unsymmetric() {
  Problem problem = partly_pinned();
  problem.ode.jacobian = [original = problem.ode.jacobian](double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx,
                                                           SparseMatrix& df_dv) {
    original(t, x, v, df_dx, df_dv);
    df_dx.coeffRef(0, 7) += 3;
    df_dv.coeffRef(8, 2) -= 2;
    df_dv.makeCompressed();
    df_dx.makeCompressed();
  };
  return problem;
}

/// M − γ D − γ² K of the free directions, and the identity of the pinned ones.
Eigen::MatrixXd filtered(const SplitOde& ode, double gamma, const Eigen::MatrixXd& K, const Eigen::MatrixXd& D) {
  Eigen::MatrixXd A = -gamma * gamma * K - gamma * D;
  A.diagonal() += solver::thrice(ode.mass);
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  for (const Pin& pin : ode.pins) P.block<3, 3>(3 * pin.particle, 3 * pin.particle) = pin.free();
  return P * A * P + Eigen::MatrixXd::Identity(A.rows(), A.cols()) - P;
}

/// How far (1 − γ J) k = r is from being fulfilled.
double left_over(const SplitOde& ode, double gamma, const Eigen::MatrixXd& K, const Eigen::MatrixXd& D, const State& r,
                 const State& k) {
  Vectors right = ode.mass.asDiagonal() * r.v;
  right.reshaped<Eigen::RowMajor>() += gamma * K * r.x.reshaped<Eigen::RowMajor>();
  filter(ode.pins, right);
  const Eigen::VectorXd kv = k.v.reshaped<Eigen::RowMajor>();
  return std::max(largest(filtered(ode, gamma, K, D) * kv - right.reshaped<Eigen::RowMajor>()),
                  largest(k.x - r.x - gamma * k.v));
}

class LinearisedSystemOf : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(, LinearisedSystemOf, testing::Bool(),
                         [](const auto& test) { return test.param ? "oblique_pins" : "pins_along_axes"; });

TEST_P(LinearisedSystemOf, IsSolvedInTheFreeDirectionsAlsoWithAnotherPattern) {
  Problem problem = unsymmetric();
  if (GetParam()) problem.ode.pins = obliquely_pinned().ode.pins;
  LinearisedSystem system(problem.ode);
  State k{noise(particles, 5), noise(particles, 6)};
  for (const double gamma : {0.3, 0.01}) {
    const State y{noise(particles, 1), gamma == 0.3 ? noise(particles, 2) : Vectors::Zero(particles, 3)};
    const State r{noise(particles, 3), noise(particles, 4)};
    ASSERT_EQ(system.factor(gamma, start_time, y), Outcome::success);
    system.solve(r, k);
    SparseMatrix K, D;
    problem.ode.jacobian(start_time, y.x, y.v, K, D);
    EXPECT_LE(left_over(problem.ode, gamma, K, D, r, k), 1e-13) << gamma;
    Vectors free = k.v;
    filter(problem.ode.pins, free);
    EXPECT_LE(largest(k.v - free), 1e-15);
  }
  EXPECT_EQ(problem.ode.work->count("factorisations"), 2);
  EXPECT_EQ(problem.ode.work->count("updates"), 2);
}

TEST(LinearisedSystem, SaysWhyItHasNoFactors) {
  Problem problem = free_particles();
  LinearisedSystem system(problem.ode);
  const double gamma = 0.1;
  problem.ode.jacobian = [&](double, const Vectors&, const Vectors&, SparseMatrix& df_dx, SparseMatrix& df_dv) {
    df_dx = known_motions::threefold(SparseMatrix(particles, particles));
    df_dv = solver::thrice(problem.ode.mass / gamma).asDiagonal();  // A = 0
  };
  EXPECT_EQ(system.factor(gamma, 0, problem.start), Outcome::breakdown);
  State broken = problem.start;
  problem.ode.jacobian = free_particles().ode.jacobian;
  broken.x(0, 0) = std::nan("");
  EXPECT_EQ(system.factor(gamma, 0, broken), Outcome::not_finite);
}

TEST(StageSolver, SolvesIncrementsWithTheConstantMatrix) {
  for (const Problem& problem : problems()) {
    solver::StageSolver stage(problem.ode, tight());
    const State r{noise(particles, 3), noise(particles, 4)};
    State k;
    ASSERT_EQ(stage.solve_increment(0.2, problem.start, r, k).outcome, Outcome::success);
    const Eigen::MatrixXd K = known_motions::threefold(problem.ode.stiffness),
                          D = known_motions::threefold(problem.ode.damping);
    EXPECT_LE(left_over(problem.ode, 0.2, K, D, r, k), 1e-12) << problem.name;
  }
}

}  // namespace
}  // namespace drape::verify::rosenbrock_test
