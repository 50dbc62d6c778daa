#include "reference/theory/linear_prediction.hpp"

#include <cmath>

#include "solver/base/decompositions.hpp"
#include "solver/base/largest.hpp"

namespace drape::reference {
namespace {

constexpr double parts[] = {1, 0.5, 0.1, 1e-2, 1e-3, 1e-4};  ///< ω²/κ of the modes

/// How many of a sheet's modes are sampled: ν from the stiffest one down in steps of 2.
constexpr int octaves = 40;

Eigen::VectorXd product(const Eigen::VectorXd& p, const Eigen::VectorXd& q) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(p.size() + q.size() - 1);
  for (Eigen::Index i = 0; i < p.size(); ++i) result.segment(i, q.size()) += p[i] * q;
  return result;
}

/// z^n as a polynomial of the degree n.
Eigen::VectorXd power_of_z(int n) { return Eigen::VectorXd::Unit(n + 1, n); }

/// z^k δ(z) of BDF(k) with δ(z) = Σ (1 − 1/z)^j/j, j = 1 … k, and then δ² + s δ + W = 0.
Eigen::VectorXd bdf_polynomial(int k, const Mode& mode) {
  const Eigen::Vector2d backward(-1, 1);
  Eigen::VectorXd D = Eigen::VectorXd::Zero(k + 1), power = Eigen::VectorXd::Ones(1);
  for (int j = 1; j <= k; ++j) {
    power = product(power, backward);
    D += product(power, power_of_z(k - j)) / j;
  }
  return product(D, D) + mode.s * product(D, power_of_z(k)) + mode.W * power_of_z(2 * k);
}

double largest_root(const Eigen::VectorXd& polynomial) {
  const Eigen::Index n = polynomial.size() - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  companion.diagonal(-1).setOnes();
  companion.col(n - 1) = -polynomial.head(n) / polynomial[n];
  return base::eigenvalues(companion).cwiseAbs().maxCoeff();
}

/// One-step methods that are A-stable by construction.
constexpr std::string_view a_stable[] = {"tr-bdf2", "esdirk3", "esdirk4"};

constexpr std::string_view higher_bdf[] = {"bdf3", "bdf4", "bdf5"};

template <std::size_t n>
bool is_one_of(const std::string_view (&names)[n], std::string_view name) {
  return std::ranges::find(names, name) != std::end(names);
}

bool never_grows(const solver::Method& method) { return method.sub_steps || is_one_of(a_stable, method.name); }

bool is_known(const solver::Method& method) {
  return never_grows(method) || is_one_of(higher_bdf, method.name) || has_theory(method.name);
}

double radius(const solver::Method& method, const Mode& mode) {
  if (never_grows(method)) return 1;
  if (is_one_of(higher_bdf, method.name)) return largest_root(bdf_polynomial(method.order, mode));
  return largest_root(characteristic_polynomial(method.name, mode));
}

}  // namespace

std::optional<LinearPrediction> predict(const solver::Method& method, double stiffness, double stiffness_to_damping) {
  if (!is_known(method)) return std::nullopt;
  LinearPrediction prediction{0, 0};
  double nu = 8 * stiffness;
  for (int k = 0; k < octaves; ++k, nu /= 2)
    for (const double part : parts) {
      const Mode mode{nu, part * nu, nu / stiffness_to_damping, 8 * stiffness / stiffness_to_damping};
      prediction.radius = base::larger(prediction.radius, radius(method, mode));
      if (has_theory(method.name)) prediction.loop = base::larger(prediction.loop, loop_contraction(method.name, mode));
    }
  return prediction;
}

}  // namespace drape::reference
