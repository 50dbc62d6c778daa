// On a single linear mode every step multiplies by the roots of a polynomial that is known; and so the largest stable step.

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "verify/small_problems.hpp"

namespace drape::verify {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;

/// Polynomials of degree 4, coefficients from the lowest.
struct Polynomial {
  Eigen::Vector<double, 5> c = Eigen::Vector<double, 5>::Zero();

  friend Polynomial operator+(const Polynomial& p, const Polynomial& q) { return {p.c + q.c}; }
  friend Polynomial operator*(double a, const Polynomial& p) { return {a * p.c}; }
  friend Polynomial operator*(const Polynomial& p, const Polynomial& q) {
    Polynomial product;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; i + j < 5; ++j) product.c[i + j] += p.c[i] * q.c[j];
    return product;
  }
  friend Polynomial operator+(const Polynomial& p, double a) { return p + Polynomial{{a, 0, 0, 0, 0}}; }
};
const Polynomial z{{0, 1, 0, 0, 0}};
const Polynomial dz = z + -1, delta = 0.5 * (3 * z + -1) * dz;

/// m x'' = −ω² m x − c m x' with K = −κ m, D = −c m:  ν = h² κ, W = h² ω², s = h c.
struct Mode {
  double nu, W, s;
};

/// The characteristic polynomial of each method: Σ p_k x_{n+k} = 0 for all n.
const std::map<std::string_view, std::function<Polynomial(const Mode&)>> characteristic = {
    {"imex-euler", [](const Mode& m) { return dz * dz + (m.nu + m.s) * z * dz + m.W * z; }},
    {"implicit-euler", [](const Mode& m) { return dz * dz + m.s * z * dz + m.W * z * z; }},
    {"midpoint", [](const Mode& m) { return dz * dz + m.s / 2 * (z * z + -1) + m.W / 4 * (z + 1) * (z + 1); }},
    {"bdf2", [](const Mode& m) { return delta * delta + m.s * z * z * delta + m.W * z * z * z * z; }},
    {"sbdf2",
     [](const Mode& m) { return delta * delta + m.s * z * z * delta + m.nu * z * z * dz * dz + m.W * z * z * (2 * z + -1); }},
    {"imex-midpoint",
     [](const Mode& m) { return (1 + m.s / 2 + m.nu / 4) * z * z + -(2 + m.nu / 2 - m.W) * z + (1 - m.s / 2 + m.nu / 4); }},
    // Without damping, whose velocity lags: the recurrence of Störmer.
    {"verlet", [](const Mode& m) { return dz * dz + m.W * z; }},
};

constexpr double h = 0.1, mass = 0.7;

solver::SplitOde ode_of(const Mode& mode) {
  const auto times = [](double a) -> SparseMatrix { return Eigen::MatrixXd::Constant(1, 1, a * mass).sparseView(); };
  auto ode = known_motions::linear_ode(Eigen::VectorXd::Constant(1, mass), times(-mode.W / h / h), times(-mode.s / h));
  ode.stiffness = times(-mode.nu / h / h);
  ode.damping = times(-mode.s / h);
  ode.explicit_force = [mode](double, const Vectors& x, const Vectors&, Vectors& f) {
    f = mass * (mode.nu - mode.W) / h / h * x;
  };
  return ode;
}

/// Its three coordinates start differently.
const State start = known_motions::single({1, 0, 0.3}, {0, 8, -5});

/// The positions of the one particle at the start and after every step, until it is 1e9 away.
std::vector<Eigen::RowVector3d> positions(std::string_view method, const Mode& mode, int steps) {
  Options options = tight();
  options.max_updates = 100'000;
  options.verlet_fraction = 1e3;  // one sub-step, stable or not
  const auto ode = ode_of(mode);
  Integrator integrator(ode, solver::method(method), options, start);
  std::vector<Eigen::RowVector3d> x = {integrator.state().x.row(0)};
  for (int n = 0; n < steps && x.back().norm() < 1e9; ++n) {
    const Outcome outcome = integrator.step(h).outcome;
    if (outcome != Outcome::success) ADD_FAILURE() << method << ": " << to_string(outcome) << " in step " << n;
    x.emplace_back(integrator.state().x.row(0));
  }
  return x;
}

/// The largest |Σ p_k x_{n+k}| beside the sizes of its summands.
double left_over(const Polynomial& p, const std::vector<Eigen::RowVector3d>& x) {
  double worst = 0;
  for (std::size_t n = 0; n + 4 < x.size(); ++n) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    double size = 0;
    for (int k = 0; k < 5; ++k) {
      sum += p.c[k] * x[n + k];
      size += std::abs(p.c[k]) * x[n + k].norm();
    }
    worst = std::max(worst, sum.norm() / size);
  }
  return worst;
}

class Amplification : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, Amplification, testing::ValuesIn(names(solver::methods())),
                         [](const auto& test) { return identifier(test.param); });

const Mode modes[] = {{1, 1, 0},     {1, 0.1, 0},   {4, 1, 0.3},   {10, 0.1, 0},   {10, 0.01, 2},
                      {0.5, 0.2, 1}, {1, 1.5, 0.2}, {100, 80, 10}, {1e3, 1, 0.01}, {0.01, 0.01, 0.1}};

TEST_P(Amplification, IsThatOfTheCharacteristicPolynomial) {
  const auto polynomial = characteristic.find(GetParam());
  ASSERT_NE(polynomial, characteristic.end()) << "the characteristic polynomial of this method is not known";
  for (Mode mode : modes) {
    if (GetParam() == "verlet") mode.s = 0;
    EXPECT_LE(left_over(polynomial->second(mode), positions(GetParam(), mode, 12)), 1e-10)
        << "nu = " << mode.nu << ", W = " << mode.W << ", s = " << mode.s;
  }
}

TEST_P(Amplification, IsNotThatOfAnotherMode) {
  const Mode mode{4, 1, 0}, other{4, 1.001, 0};
  EXPECT_GE(left_over(characteristic.at(GetParam())(other), positions(GetParam(), mode, 12)), 1e-5);
}

/// The updates of the third step.
int updates(std::string_view method, const Mode& mode, double loop_tolerance) {
  Options options = tight();
  options.loop_tolerance = loop_tolerance;
  const auto ode = ode_of(mode);
  Integrator integrator(ode, solver::method(method), options, start);
  integrator.step(h), integrator.step(h);
  return integrator.step(h).updates;
}

TEST(FixedPointLoop, ContractsAsTheModeSays) {
  for (const auto& [method, c] : {std::pair("implicit-euler", 1.0), {"bdf2", 2.0 / 3}, {"midpoint", 0.5}})
    for (const auto& [nu, W, s] : {Mode{1, 1.5, 0}, {4, 1, 0.3}, {10, 0.1, 0}, {100, 1, 5}}) {
      const double contraction = c * c * std::abs(nu - W) / (1 + c * c * nu + c * s);
      const double predicted = std::log(1e-4 / 1e-10) / -std::log(contraction);
      EXPECT_NEAR(updates(method, {nu, W, s}, 1e-10) - updates(method, {nu, W, s}, 1e-4), predicted, 1.01)
          << method << " with nu = " << nu;
    }
}

double farthest(const std::vector<Eigen::RowVector3d>& x) {
  double distance = 0;
  for (const Eigen::RowVector3d& p : x) distance = std::max(distance, p.norm());
  return distance;
}

/// Where a method becomes unstable.
struct Limit {
  std::string method;
  double nu, s;
  double W;
};
const std::vector<Limit> limits = {{"imex-euler", 0.5, 0, 4 + 2 * 0.5},  {"imex-euler", 3, 0.4, 4 + 2 * 3 + 2 * 0.4},
                                   {"imex-euler", 50, 10, 4 + 100 + 20}, {"sbdf2", 0.5, 0, 0.5 * 2.5},
                                   {"sbdf2", 1.5, 0, 1.5 * 3.5},         {"sbdf2", 3, 0, (16 + 12) / 3.0},
                                   {"sbdf2", 50, 0, (16 + 200) / 3.0},   {"imex-midpoint", 0.5, 0.2, 4.5},
                                   {"imex-midpoint", 30, 0.2, 34},       {"verlet", 0, 0, 4}};

TEST(StabilityLimit, IsWhereTheMethodsBlowUp) {
  for (const auto& [method, nu, s, W] : limits) {
    EXPECT_LE(farthest(positions(method, {nu, 0.99 * W, s}, 3000)), 1e3) << method << " with nu = " << nu;
    EXPECT_GE(farthest(positions(method, {nu, 1.01 * W, s}, 100'000)), 1e9) << method << " with nu = " << nu;
  }
}

TEST(StabilityLimit, DoesNotExistForImplicitMethods) {
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"})
    for (const double W : {1e-2, 1.0, 4.1, 1e2}) {
      const auto x = positions(method, {W, W, 0}, 100);
      EXPECT_LE(farthest({x.end() - 50, x.end()}), farthest({x.begin(), x.begin() + 50}) * 1.001)
          << method << " with W = " << W;
    }
}

}  // namespace
}  // namespace drape::verify
