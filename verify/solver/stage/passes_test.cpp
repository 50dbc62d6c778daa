// Stages that count as solved after a number of passes of the loop: each linear mode then multiplies by the roots of a known
// polynomial, and the order in time depends on whether the explicit forces depend on velocities.

#include <gtest/gtest.h>

#include <cmath>

#include "reference/theory/amplification.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::passes_test {
namespace {

using namespace small_problems;
using reference::Mode;
using reference::mode_ode;
using solver::Integrator;
using solver::Outcome;

Options after(int passes, const char* stage = "fixed-point") {
  Options options = tight();
  options.stage = &solver::stage_kind(stage);
  options.passes = passes;
  return options;
}

/// Positions of one particle on a mode, from the start and after every step, until it is 1e9 away.
std::vector<Eigen::RowVector3d> positions(const char* name, const Mode& mode, int steps, int passes) {
  const double h = 0.1;
  const auto ode = mode_ode({mode.nu / h / h, mode.W / h / h, mode.s / h});
  Integrator integrator(ode, solver::method(name), after(passes), known_motions::single({1, 0, 0.3}, {0, 8, -5}));
  std::vector<Eigen::RowVector3d> x = {integrator.state().x.row(0)};
  for (int n = 0; n < steps && x.back().norm() < 1e9; ++n) {
    const auto result = integrator.step(h);
    EXPECT_EQ(result.outcome, Outcome::success) << name << " in step " << n;
    EXPECT_EQ(result.updates, passes) << name << " in step " << n;
    x.emplace_back(integrator.state().x.row(0));
  }
  return x;
}

/// The largest |Σ p_k x_{n+k}| beside the sizes of its summands.
double left_over(const std::vector<double>& p, const std::vector<Eigen::RowVector3d>& x) {
  double worst = 0;
  for (std::size_t n = 0; n + p.size() <= x.size(); ++n) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    double size = 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      sum += p[k] * x[n + k];
      size += std::abs(p[k]) * x[n + k].norm();
    }
    worst = std::max(worst, sum.norm() / size);
  }
  return worst;
}

/// The characteristic polynomial of a method whose stages take one pass, the constant first; and the largest stable W.
struct OnePass {
  const char* method;
  std::vector<double> (*polynomial)(const Mode&);
  double (*bound)(double nu, double s);
};

/// Δ² + s z² Δ + ⅔ (ν − W) z (z − 1) Δ + W z⁴ with Δ = (3 z − 1)(z − 1)/2.
std::vector<double> bdf2_polynomial(const Mode& m) {
  const double b = 2.0 / 3 * (m.nu - m.W);
  return {0.25, -2 - 0.5 * b, 5.5 + 0.5 * m.s + 2.5 * b, -6 - 2 * m.s - 3.5 * b, 2.25 + 1.5 * (m.s + b) + m.W};
}

const OnePass one_pass[] = {
    {"implicit-euler",
     [](const Mode& m) {
       return std::vector{1 + m.nu - m.W, -(2 + 2 * m.nu + m.s - 2 * m.W), 1 + m.nu + m.s};
     },
     [](double nu, double s) { return (4 + 4 * nu + 2 * s) / 3; }},
    {"midpoint",  // that of imex-midpoint
     [](const Mode& m) {
       return std::vector{1 - m.s / 2 + m.nu / 4, -(2 + m.nu / 2 - m.W), 1 + m.s / 2 + m.nu / 4};
     },
     [](double nu, double) { return 4 + nu; }},
};

constexpr Mode modes[] = {{1, 1, 0}, {4, 1, 0.3}, {10, 0.1, 0}, {10, 0.01, 2}, {1, 1.5, 0.2}, {100, 80, 10}};

TEST(OnePass, MultipliesModesByTheRootsOfItsPolynomial) {
  for (const auto& [name, polynomial, bound] : one_pass) {
    for (const Mode& mode : modes)
      EXPECT_LE(left_over(polynomial(mode), positions(name, mode, 12, 1)), 1e-10) << name << " with nu = " << mode.nu;
    EXPECT_GE(left_over(polynomial({4, 1.001, 0}), positions(name, {4, 1, 0}, 12, 1)), 1e-5) << name;
    EXPECT_GE(left_over(polynomial({4, 1, 0}), positions(name, {4, 1, 0}, 12, 2)), 1e-3) << name << " with two passes";
  }
}

double farthest(const std::vector<Eigen::RowVector3d>& x) {
  double distance = 0;
  for (const Eigen::RowVector3d& p : x) distance = std::max(distance, p.norm());
  return distance;
}

TEST(OnePass, IsStableUpToItsBound) {
  for (const auto& [name, polynomial, bound] : one_pass)
    for (const double nu : {0.5, 3.0, 50.0})
      for (const double s : {0.0, 0.4}) {
        EXPECT_LE(farthest(positions(name, {nu, 0.99 * bound(nu, s), s}, 3000, 1)), 1e3) << name << " with nu = " << nu;
        EXPECT_GE(farthest(positions(name, {nu, 1.01 * bound(nu, s), s}, 30'000, 1)), 1e9) << name << " with nu = " << nu;
      }
}

/// Undamped; Δ and W as in the polynomial.
TEST(OnePass, OfBdf2HasItsPolynomialAndItsBound) {
  const auto bound = [](double nu) { return (48 + 16 * nu) / 13; };
  for (const double nu : {0.5, 3.0, 50.0}) {
    EXPECT_LE(farthest(positions("bdf2", {nu, 0.99 * bound(nu), 0}, 3000, 1)), 1e3) << nu;
    EXPECT_GE(farthest(positions("bdf2", {nu, 1.01 * bound(nu), 0}, 30'000, 1)), 1e9) << nu;
  }
  for (const Mode& mode : modes) EXPECT_LE(left_over(bdf2_polynomial(mode), positions("bdf2", mode, 12, 1)), 1e-10) << mode.nu;
}

/// The error that is left in a stage, beside what one pass less leaves.
TEST(Passes, ReduceTheErrorAsTheModeSays) {
  const double h = 0.1;
  for (const Mode& mode : {Mode{1, 1.5, 0}, {4, 1, 0.3}, {10, 0.1, 0}, {100, 1, 5}}) {
    const auto ode = mode_ode({mode.nu / h / h, mode.W / h / h, mode.s / h});
    const auto end = [&](int passes) {
      Integrator integrator(ode, solver::method("implicit-euler"), after(passes),
                            known_motions::single({1, 0, 0.3}, {0, 8, -5}));
      integrator.step(h);
      return integrator.state().v;
    };
    const Vectors exact = end(0);
    const double factor = (end(5) - exact).norm() / (end(4) - exact).norm();
    EXPECT_NEAR(factor, reference::loop_contraction("implicit-euler", mode), 1e-5) << mode.nu;
  }
}

/// x'' = −2 x − 0.3 x³ − c v, of which −5 x is implicit; the drag c v is implicit or not.
SplitOde oscillator(bool explicit_drag) {
  const double c = 0.4;
  const auto one = [](double a) -> SparseMatrix { return Eigen::MatrixXd::Constant(1, 1, a).sparseView(); };
  SplitOde ode;
  ode.mass = Eigen::VectorXd::Ones(1);
  ode.stiffness = one(-5);
  ode.damping = explicit_drag ? SparseMatrix(1, 1) : one(-c);
  ode.force = [=](double, const Vectors& x, const Vectors& v, Vectors& f) {
    f = -2 * x - 0.3 * x.cwiseProduct(x).cwiseProduct(x) - c * v;
  };
  return ode;
}

Convergence errors(const char* method, bool explicit_drag, const Options& options) {
  const SplitOde ode = oscillator(explicit_drag);
  const auto end = [&](const char* name, const Options& chosen, int steps) {
    Integrator integrator(ode, solver::method(name), chosen, known_motions::single({1, 0.5, -0.8}, {0, 1, 0.3}));
    for (int n = 0; n < steps; ++n) EXPECT_EQ(integrator.step(2.0 / steps).outcome, Outcome::success);
    return integrator.state();
  };
  const State exact = end("rk4", {}, 4000);
  Convergence measured;
  for (const int steps : {200, 400, 800, 1600}) {
    measured.steps.push_back(2.0 / steps);
    measured.errors.push_back(distance(end(method, options, steps), exact));
  }
  return measured;
}

TEST(OnePass, IsOfSecondOrderOnlyIfExplicitForcesDoNotDependOnVelocities) {
  for (const char* method : {"bdf2", "midpoint"}) {
    EXPECT_TRUE(has_order(errors(method, false, after(1)), 2)) << method;
    EXPECT_TRUE(has_order(errors(method, true, after(1)), 1)) << method;
    EXPECT_FALSE(has_order(errors(method, true, after(1)), 2)) << method;
  }
}

TEST(TwoPasses, AreOfSecondOrder) {
  for (const char* method : {"bdf2", "midpoint"})
    for (const bool explicit_drag : {false, true}) EXPECT_TRUE(has_order(errors(method, explicit_drag, after(2)), 2)) << method;
}

TEST(Passes, AreTheOptionsOrThoseOfTheStageSolver) {
  const Problem problem = free_particles();
  const auto updates = [&](const Options& options) {
    Integrator integrator(problem.ode, solver::method("implicit-euler"), options, problem.start, start_time);
    return integrator.step(0.04).updates;
  };
  EXPECT_EQ(updates(after(0, "projective")), 10);
  EXPECT_EQ(updates(after(3, "projective")), 3);
  for (const char* kind : {"fixed-point", "printed-loop", "chebyshev", "lbfgs"}) EXPECT_EQ(updates(after(3, kind)), 3) << kind;
  EXPECT_GT(updates(after(0)), 10);
}

}  // namespace
}  // namespace drape::verify::passes_test
