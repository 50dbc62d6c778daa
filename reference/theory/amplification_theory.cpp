#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "reference/theory/amplification.hpp"
#include "solver/base/registry.hpp"
#include "solver/stability.hpp"

namespace drape::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Polynomials of degree 4, coefficients from the lowest.
struct Polynomial {
  Eigen::Vector<double, 5> c = Eigen::Vector<double, 5>::Zero();

  friend Polynomial operator+(const Polynomial& p, const Polynomial& q) { return {p.c + q.c}; }
  friend Polynomial operator+(const Polynomial& p, double a) { return p + Polynomial{{a, 0, 0, 0, 0}}; }
  friend Polynomial operator*(double a, const Polynomial& p) { return {a * p.c}; }
  friend Polynomial operator*(const Polynomial& p, const Polynomial& q) {
    Polynomial product;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; i + j < 5; ++j) product.c[i + j] += p.c[i] * q.c[j];
    return product;
  }
};

/// The theory of a method on a linear mode.
struct Theory {
  std::string_view name;
  double stage;  ///< γ/h of the fixed-point loop, 0 if there is none
  Polynomial (*characteristic)(const Mode&);
  double (*stability_bound)(double nu, double s);
  Artificial (*artificial)(const Mode&);
  double inertia = 1;  ///< μ of its stages
};

const Polynomial z{{0, 1, 0, 0, 0}};
const Polynomial dz = z + -1, delta = 0.5 * (3 * z + -1) * dz;

Polynomial implicit_euler(const Mode& m) { return dz * dz + m.s * z * dz + m.W * z * z; }
Polynomial midpoint(const Mode& m) { return dz * dz + m.s / 2 * (z * z + -1) + m.W / 4 * (z + 1) * (z + 1); }
Polynomial bdf2(const Mode& m) { return delta * delta + m.s * z * z * delta + m.W * z * z * z * z; }

/// The two roots of μ² + s μ + W.
std::pair<std::complex<double>, std::complex<double>> exponents(const Mode& m) {
  const double square = m.s * m.s / 4 - m.W;
  const std::complex<double> larger = -m.s / 2 - std::sqrt(std::complex<double>(square));
  return {larger, square < 0 ? std::conj(larger) : m.W / larger};
}

/// The polynomial of a Rosenbrock method whose number of stages, order and γ determine R(μ): R(μ) (1 − γ μ)^stages is the
/// series of e^μ (1 − γ μ)^stages up to the order   [Hairer, Wanner 1996, IV.7].
Polynomial rosenbrock(const Mode& m, int stages, int order, double gamma) {
  const auto R = [=](std::complex<double> mu) {
    std::complex<double> numerator = 0;
    double binomial = 1;  // of (−γ μ)^i
    for (int i = 0; i <= stages; ++i) {
      double factorial = 1;
      for (int j = i; j <= order; ++j) {
        numerator += binomial / factorial * std::pow(-gamma, i) * std::pow(mu, j);
        factorial *= j + 1 - i;
      }
      binomial *= double(stages - i) / (i + 1);
    }
    return numerator / std::pow(1.0 - gamma * mu, stages);
  };
  const auto [mu1, mu2] = exponents(m);
  return z * z + -(R(mu1) + R(mu2)).real() * z + (R(mu1) * R(mu2)).real();
}

/// Coefficients of the generalised α-method for equal steps   [Chung, Hulbert 1993].
struct GeneralizedAlpha {
  double m, f, gamma = 0.5 - m + f, beta = 0.25 * (1 - m + f) * (1 - m + f);

  double stage() const { return beta / gamma; }
  double inertia() const { return beta * (1 - m) / ((1 - f) * gamma * gamma); }

  /// With a(z) for the accelerations: (z − 1) v = (1 − γ + γ z) a, (z − 1) x = v + (½ − β + β z) a.
  Polynomial characteristic(const Mode& mode) const {
    const Polynomial of_a = (1 - m) * z + m, of_y = (1 - f) * z + f, v = gamma * z + (1 - gamma);
    return of_a * dz * dz + mode.s * of_y * v * dz + mode.W * of_y * (v + dz * (beta * z + (0.5 - beta)));
  }
};
constexpr GeneralizedAlpha radius_08{1.0 / 3, 4.0 / 9}, radius_05{0, 1.0 / 3}, hht{0, 0.1}, newmark{0, 0};

double no_bound(double, double) { return infinity; }
Artificial nothing_artificial(const Mode&) { return {0, 0}; }
Artificial euler_artificial(const Mode& m) { return {m.s / 2, m.W}; }

/// z² − tr R z + det R: a Runge-Kutta method multiplies (x, h v) by its stability function R of this matrix.
Eigen::Matrix2d exponent(const Mode& m) { return Eigen::Matrix2d{{0, 1}, {-m.W, -m.s}}; }
Polynomial of_runge_kutta(const Eigen::Matrix2d& R) { return z * z + -R.trace() * z + R.determinant(); }

/// 1 + Z + Z²/2 + … up to the power of the order.
template <int order>
Polynomial truncated_exponential(const Mode& m) {
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
  for (int k = order; k > 0; --k) R = Eigen::Matrix2d::Identity() + exponent(m) * R / k;
  return of_runge_kutta(R);
}

double with_safety(const Mode& m) { return solver::spectrum_safety * std::max(m.s, m.stiffest_s); }

/// 1 − b + b P_s(1 + 4 Z/(s² + s − 2)), Legendre's P_s by (k + 1) P_{k+1} = (2 k + 1) X P_k − k P_{k−1}.
Polynomial legendre(const Mode& m) {
  const double s = solver::rkl2_stages(with_safety(m)), d = s * s + s - 2, b = d / (2 * s * (s + 1));
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity(), X = I + 4 / d * exponent(m);
  Eigen::Matrix2d before = I, P = X;
  for (double k = 1; k < s; ++k) {
    const Eigen::Matrix2d next = ((2 * k + 1) * X * P - k * before) / (k + 1);
    before = P;
    P = next;
  }
  return of_runge_kutta((1 - b) * I + b * P);
}

/// 1 − b T_s(w0) + b T_s(w0 + w1 Z), Chebyshev's T_s(cosh θ) = cosh s θ with its derivatives.
Polynomial chebyshev(const Mode& m) {
  const double s = solver::rkc2_stages(with_safety(m)), w0 = 1 + solver::rkc2_damping / (s * s);
  const double theta = std::acosh(w0), sinh = std::sinh(theta), T = std::cosh(s * theta), dT = s * std::sinh(s * theta) / sinh;
  const double ddT = (s * s * T - w0 * dT) / (sinh * sinh), b = ddT / (dT * dT);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity(), X = w0 * I + dT / ddT * exponent(m);
  Eigen::Matrix2d before = I, P = X;
  for (double k = 1; k < s; ++k) {
    const Eigen::Matrix2d next = 2 * X * P - before;
    before = P;
    P = next;
  }
  return of_runge_kutta((1 - b * T) * I + b * P);
}

/// Methods that make undamped motion grow: with damping the limit is not known.
double none_if_undamped(double, double s) { return s > 0 ? not_known : 0; }

/// 2√2 squared.
double rk4_bound(double, double s) { return s > 0 ? not_known : 8; }

// With z = exp(μ), each polynomial divided by a power of z is (1 + inertia) μ² + (s + damping) μ + W up to relative O(μ²):
// 1 − 1/z = μ − μ²/2 + …, δ/z² = μ − μ³/3 + …, and μ³ is reduced by the equation itself.
const Theory theories[] = {
    {"imex-euler", 0,  //
     [](const Mode& m) { return dz * dz + (m.nu + m.s) * z * dz + m.W * z; },
     [](double nu, double s) { return 4 + 2 * nu + 2 * s; },
     [](const Mode& m) {
       return Artificial{(m.nu + m.s) / 2, m.nu};
     }},
    {"implicit-euler", 1,  //
     implicit_euler, no_bound, euler_artificial},
    {"sbdf2", 0,
     [](const Mode& m) { return delta * delta + m.s * z * z * delta + m.nu * z * z * dz * dz + m.W * z * z * (2 * z + -1); },
     [](double nu, double s) { return s > 0 ? not_known : std::min(nu * (nu + 2), (16 + 4 * nu) / 3); },
     [](const Mode& m) {
       const double explicit_part = m.nu - m.W, b = explicit_part / (1 + explicit_part);
       return Artificial{explicit_part + b * m.s, b * m.W};
     }},
    {"bdf2", 2.0 / 3,  //
     bdf2, no_bound, nothing_artificial},
    {"midpoint", 0.5,  //
     midpoint, no_bound, nothing_artificial},
    {"imex-midpoint", 0,
     [](const Mode& m) { return (1 + m.s / 2 + m.nu / 4) * z * z + -(2 + m.nu / 2 - m.W) * z + (1 - m.s / 2 + m.nu / 4); },
     [](double nu, double) { return 4 + nu; },
     [](const Mode& m) {
       return Artificial{m.nu / 4, 0};
     }},
    {"verlet", 0,  //
     [](const Mode& m) { return z * dz * dz + m.s * delta + m.W * z * z; },
     [](double, double s) { return std::max(0.0, 4 - 4 * s); }, nothing_artificial},
    {"baraff-witkin", 0, implicit_euler, no_bound, euler_artificial},
    {"one-newton-bdf2", 0, bdf2, no_bound, nothing_artificial},
    {"ros2", 0, [](const Mode& m) { return rosenbrock(m, 2, 2, 1 - std::sqrt(0.5)); }, no_bound, nothing_artificial},
    {"ros3p", 0, [](const Mode& m) { return rosenbrock(m, 3, 3, 0.5 + std::sqrt(3) / 6); }, no_bound, nothing_artificial},
    {"rodas3", 0, [](const Mode& m) { return rosenbrock(m, 4, 3, 0.5); }, no_bound, nothing_artificial},
    {"ros34pw2", 0, [](const Mode& m) { return rosenbrock(m, 4, 3, 0.435866521508459); }, no_bound, nothing_artificial},
    {"explicit-euler", 0, truncated_exponential<1>, [](double, double s) { return s <= 2 ? s : not_known; },
     [](const Mode& m) {
       return Artificial{-m.s / 2, -m.W};
     }},
    {"explicit-midpoint", 0, truncated_exponential<2>,
     [](double, double s) { return s <= 2 ? s + std::sqrt(s * (4 - s)) : not_known; }, nothing_artificial},
    {"rk4", 0, truncated_exponential<4>, rk4_bound, nothing_artificial},
    {"rk4-substeps", 0, truncated_exponential<4>, rk4_bound, nothing_artificial},
    {"bridson", 0,  //
     [](const Mode& m) { return dz * dz + m.s / 2 * (z * z + -1) + m.W * z; }, [](double, double) { return 4.0; },
     nothing_artificial},
    {"rkl2", 0, legendre, none_if_undamped, nothing_artificial},
    {"rkc2", 0, chebyshev, none_if_undamped, nothing_artificial},
    {"generalized-alpha", radius_08.stage(), [](const Mode& m) { return radius_08.characteristic(m); }, no_bound,
     nothing_artificial, radius_08.inertia()},
    {"generalized-alpha-0.5", radius_05.stage(), [](const Mode& m) { return radius_05.characteristic(m); }, no_bound,
     nothing_artificial, radius_05.inertia()},
    {"newmark", newmark.stage(), [](const Mode& m) { return newmark.characteristic(m); }, no_bound, nothing_artificial,
     newmark.inertia()},
    {"hht", hht.stage(), [](const Mode& m) { return hht.characteristic(m); }, no_bound, nothing_artificial, hht.inertia()},
    {"energy-momentum", 0.5, midpoint, no_bound, nothing_artificial},
};

const Theory& theory(std::string_view method) { return base::find_named<Theory>(theories, "method with a theory", method); }

/// The slower root of (inertia) μ² + (damping) μ + W = 0.
ModeBehaviour oscillator(double inertia, double damping, double W) {
  const double discriminant = damping * damping - 4 * inertia * W;
  if (discriminant < 0) return {std::sqrt(-discriminant) / (2 * inertia), damping / (2 * inertia)};
  return {0, 2 * W / (damping + std::sqrt(discriminant))};
}

}  // namespace

ModeBehaviour exact_behaviour(const Mode& mode) { return oscillator(1, mode.s, mode.W); }

bool has_theory(std::string_view method) { return std::ranges::find(theories, method, &Theory::name) != std::end(theories); }

Eigen::VectorXd characteristic_polynomial(std::string_view method, const Mode& mode) {
  const Eigen::VectorXd c = theory(method).characteristic(mode).c;
  Eigen::Index degree = c.size() - 1;
  while (c[degree] == 0) --degree;
  return c.head(degree + 1) / c[degree];
}

double loop_contraction(std::string_view method, const Mode& mode) {
  const double c = theory(method).stage;
  return c * c * std::abs(mode.nu - mode.W) / (theory(method).inertia + c * c * mode.nu + c * mode.s);
}

double stability_bound(std::string_view method, double nu, double s) { return theory(method).stability_bound(nu, s); }

Artificial artificial(std::string_view method, const Mode& mode) { return theory(method).artificial(mode); }

ModeBehaviour predicted_behaviour(std::string_view method, const Mode& mode) {
  const auto [inertia, damping] = artificial(method, mode);
  return oscillator(1 + inertia, mode.s + damping, mode.W);
}

}  // namespace drape::reference
