// Functions of the Jacobian by Krylov spaces are those of the dense matrix, and exponential methods are exact for linear
// forces, however long the step.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "reference/theory/amplification.hpp"
#include "solver/linear/phi_functions.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::exponential_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::MatrixExponential;
using solver::Outcome;
using solver::PhiFunctions;

constexpr const char* exponential_methods[] = {"exponential-euler", "epirk4s3a"};

Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) {
  MatrixExponential function(A.rows());
  function.compute(A);
  return function.result();
}

Eigen::MatrixXd random_matrix(int n, unsigned seed) {
  const Vectors numbers = noise(n * n, seed);
  return Eigen::Map<const Eigen::MatrixXd>(numbers.data(), n, n);
}

TEST(MatrixExponential, TurnsAndDecaysAsInClosedForm) {
  for (const double w : {0.0, 0.1, 1.0, 30.0, 1000.0}) {
    const Eigen::Matrix2d A{{-0.3, w}, {-w, -0.3}};
    const Eigen::Matrix2d turned = std::exp(-0.3) * Eigen::Rotation2Dd(-w).toRotationMatrix();
    EXPECT_LE(largest(exponential(A) - turned), 1e-15 * std::max(10.0, 5 * w)) << w;
  }
}

TEST(MatrixExponential, IsThatOfTheEigenvaluesAlsoInSlices) {
  const int n = 130;
  const Eigen::MatrixXd T = random_matrix(n, 1) / 20 + Eigen::MatrixXd::Identity(n, n), inverse = T.inverse();
  const Eigen::VectorXd decays = Eigen::VectorXd::LinSpaced(n, -300, 0.5);
  const Eigen::MatrixXd expected = T * decays.array().exp().matrix().asDiagonal() * inverse;
  EXPECT_LE(largest(exponential(T * decays.asDiagonal() * inverse) - expected), 1e-10);
}

TEST(MatrixExponential, OfANilpotentMatrixEnds) {
  const Eigen::Matrix4d N{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}};
  EXPECT_LE(
      largest(exponential(10 * N) - Eigen::Matrix4d{{1, 10, 50, 1000.0 / 6}, {0, 1, 10, 50}, {0, 0, 1, 10}, {0, 0, 0, 1}}),
      1e-12);
}

TEST(MatrixExponential, IsNotFiniteWhereTheMatrixIsNot) {
  EXPECT_FALSE(exponential(Eigen::Matrix2d{{0, std::nan("")}, {1, 0}}).allFinite());
}

/// hJ of (x, v) as a dense matrix, its rows of pinned coordinates 0.
Eigen::MatrixXd dense_jacobian(const Problem& problem, double h, const State& y) {
  SparseMatrix K, D;
  problem.ode.jacobian(start_time, y.x, y.v, K, D);
  const Eigen::Index n = 3 * particles;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  const Eigen::VectorXd inverse_masses = solver::thrice(problem.ode.mass).cwiseInverse();
  J.topRightCorner(n, n).setIdentity();
  J.bottomLeftCorner(n, n) = inverse_masses.asDiagonal() * Eigen::MatrixXd(K);
  J.bottomRightCorner(n, n) = inverse_masses.asDiagonal() * Eigen::MatrixXd(D);
  for (const Pin& pin : problem.ode.pins) {
    auto rows = J.middleRows<3>(n + 3 * pin.particle);
    rows = (pin.free() * rows).eval();
  }
  return h * J;
}

Eigen::VectorXd flat(const State& y) {
  Eigen::VectorXd all(2 * y.x.size());
  all << y.x.reshaped<Eigen::RowMajor>(), y.v.reshaped<Eigen::RowMajor>();
  return all;
}

/// Σ c^p φ_p(c A) b_p by the series φ_p(A) = A φ_{p+1}(A) + 1/p!, as a block of an exponential.
Eigen::VectorXd dense_sum(const Eigen::MatrixXd& A, const std::vector<Eigen::VectorXd>& b, double c) {
  const Eigen::Index n = A.rows(), P = Eigen::Index(b.size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + P, n + P);
  whole.topLeftCorner(n, n) = A;
  for (Eigen::Index p = 0; p < P; ++p) whole.col(n + p).head(n) = b[p];
  for (Eigen::Index p = 1; p < P; ++p) whole(n + p, n + p - 1) = 1;
  return exponential(c * whole).col(n).head(n);
}

/// Inputs as motions have them: those of pinned velocities are 0.
std::vector<State> inputs(const SplitOde& ode) {
  std::vector<State> all;
  for (unsigned p = 0; p < 4; ++p) {
    all.push_back({noise(particles, 20 + p), noise(particles, 30 + p)});
    filter(ode.pins, all.back().v);
  }
  return all;
}

TEST(PhiFunctions, AreThoseOfTheDenseMatrix) {
  for (const Problem& problem : problems())
    for (const double h : {0.01, 1.0, 20.0}) {
      PhiFunctions phi(problem.ode);
      ASSERT_EQ(phi.linearise(h, start_time, problem.start), Outcome::success);
      std::vector<Eigen::VectorXd> b;
      const std::vector<State> given = inputs(problem.ode);
      for (int p = 0; p < 4; ++p) {
        phi.set_input(p + 1, given[p]);
        b.push_back(flat(given[p]));
      }
      const double error = 1e-9 * phi.size(1);
      State half, whole;
      ASSERT_EQ(phi.evaluate(6, std::vector<PhiFunctions::Output>{{3, &half}, {6, &whole}}, error), Outcome::success);
      const Eigen::MatrixXd A = dense_jacobian(problem, h, problem.start);
      const Eigen::VectorXd truth = dense_sum(A, b, 1), truth_half = dense_sum(A, b, 0.5);
      EXPECT_LE(largest(flat(whole) - truth), 1e-7 * largest(truth)) << problem.name << ", h = " << h;
      EXPECT_LE(largest(flat(half) - truth_half), 1e-7 * largest(truth)) << problem.name << ", h = " << h;
      State product;
      phi.multiply(given[0], product);
      EXPECT_LE(largest(flat(product) - A * b[0]), 1e-12 * largest(A)) << problem.name;
    }
}

TEST(PhiFunctions, AreZeroWithoutInputs) {
  const Problem problem = free_particles();
  PhiFunctions phi(problem.ode);
  ASSERT_EQ(phi.linearise(1, start_time, problem.start), Outcome::success);
  State w{noise(particles, 1), noise(particles, 2)};
  ASSERT_EQ(phi.evaluate(1, std::vector<PhiFunctions::Output>{{1, &w}}, 1e-9), Outcome::success);
  EXPECT_EQ(largest(flat(w)), 0);
}

/// More springs in a row than one Krylov space has dimensions for where steps are long.
struct Row {
  SplitOde ode;
  State start;
};
Row row_of_springs(int n, double damping) {
  const SparseMatrix K = known_motions::row_of_springs(n, 1);
  return {known_motions::linear_ode(Eigen::VectorXd::LinSpaced(n, 1, 2), K, damping * K), {noise(n, 1), noise(n, 2)}};
}

State after(const Row& row, std::string_view method, double h, int steps) {
  Integrator integrator(row.ode, solver::method(method), {}, row.start);
  for (int k = 0; k < steps; ++k) EXPECT_EQ(integrator.step(h).outcome, Outcome::success);
  return integrator.state();
}

TEST(ExponentialMethods, AreExactForLinearForcesWhateverTheStep) {
  DRAPE_SLOW();
  for (const double damping : {0.0, 0.1, 30.0}) {
    const Row row = row_of_springs(100, damping);
    for (const char* method : exponential_methods) {
      const State many = after(row, method, 0.5, 600), one = after(row, method, 300, 1);
      EXPECT_LE(distance(one, many), 1e-7 * largest(many.x)) << method << ", " << damping;
      EXPECT_GE(distance(many, row.start), 0.1);
    }
  }
}

TEST(ExponentialMethods, CutLongSteps) {
  const Row row = row_of_springs(100, 0);
  after(row, "exponential-euler", 300, 1);
  EXPECT_GT(row.ode.work->count("jacobian_products"), 2 * 180) << "more than two spaces hold";
  EXPECT_LT(row.ode.work->count("jacobian_products"), 2000) << "about two for a radian of the fastest oscillation";
}

TEST(ExponentialMethods, SaySoWhereTheStepNeedsTooManyCuts) {
  DRAPE_SLOW();
  const Row row = row_of_springs(100, 0);
  Integrator integrator(row.ode, solver::method("exponential-euler"), {}, row.start);
  EXPECT_EQ(integrator.step(1e9).outcome, Outcome::not_converged);
  EXPECT_EQ(integrator.state().x, row.start.x);
}

TEST(ExponentialMethods, MultiplyModesByTheirExponential) {
  for (const char* method : exponential_methods)
    for (const double W : {0.01, 1.0, 400.0, 1e6})
      for (const double s : {0.0, 0.3, 100.0}) {
        const double w = std::sqrt(W);  // balanced: else the norm would be W
        Eigen::MatrixXd exact = exponential(Eigen::Matrix2d{{0, w}, {-w, -s}});
        exact(0, 1) /= w;
        exact(1, 0) *= w;
        const Eigen::MatrixXd G = reference::amplification_matrix(solver::method(method), {W, W, s});
        EXPECT_LE(largest(G - exact), 1e-8 * std::max(1.0, std::sqrt(W))) << method << ", W = " << W << ", s = " << s;
      }
}

/// The estimated error of a step over the true one.
double estimate_over_error(const char* method, double h) {
  const Problem problem = free_particles();
  Options options = tight();
  options.error_control = {.tolerance = 1, .length = 1, .duration = 1};
  Integrator integrator(problem.ode, solver::method(method), options, problem.start, start_time);
  EXPECT_EQ(integrator.step(h).outcome, Outcome::success);
  const State exact = problem.exact(start_time + h), &y = integrator.state();
  const double error = std::hypot((y.x - exact.x).norm(), (y.v - exact.v).norm()) / std::sqrt(6 * particles);
  return integrator.error() / error;
}

TEST(ExponentialMethods, EstimateTheirErrorByTheOrderBetween) {
  EXPECT_NEAR(estimate_over_error("exponential-euler", 0.01), 1, 0.1) << "by a method of an order more";
  EXPECT_GE(estimate_over_error("epirk4s3a", 0.05), 1) << "that of the embedded method, of an order less";
}

}  // namespace
}  // namespace drape::verify::exponential_test
