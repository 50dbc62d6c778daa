#include "model/memory/path.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace drape::model {
namespace {

/// m_k = ∫_0^1 θ e^{−θ (1 − τ)} τ^k dτ: by the recursion m_k = 1 − k/θ m_{k−1}, which loses digits where θ is small, there by
/// m_k = θ Σ_j (−θ)^j k!/(k + j + 1)!.
std::array<double, most_nodes> moments(double theta, int count) {
  constexpr double small = 2;
  constexpr int terms = 30;
  std::array<double, most_nodes> m{};
  for (int k = 0; k < count; ++k) {
    if (std::abs(theta) > small) {
      m[k] = k == 0 ? -std::expm1(-theta) : 1 - k / theta * m[k - 1];
      continue;
    }
    double term = theta / (k + 1);
    for (int j = 1; j <= terms; ++j) {
      m[k] += term;
      term *= -theta / (k + j + 1);
    }
  }
  return m;
}

}  // namespace

// Weights w of nodes τ_i reproduce the moments of all monomials: Σ w_i (τ^k)(τ_i) = m_k, for rates with its derivative.
PathWeights path_weights(double theta, int nodes, double older) {
  const std::array<double, most_nodes> m = moments(theta, nodes);
  if (nodes == 2) {
    PathWeights w{};
    w[at_begin] = m[0] - m[1];
    w[at_end] = m[1];
    return w;
  }
  const double places[] = {0, 1, -older};
  Eigen::Matrix<double, most_nodes, most_nodes> V = Eigen::Matrix<double, most_nodes, most_nodes>::Identity();
  Eigen::Matrix<double, most_nodes, 1> right = Eigen::Matrix<double, most_nodes, 1>::Zero();
  for (int k = 0; k < nodes; ++k) {
    right[k] = m[k];
    for (int i = 0; i < nodes; ++i) {
      const double tau = places[i / 2];
      V(k, i) = i % 2 == 0 ? std::pow(tau, k) : (k == 0 ? 0 : k * std::pow(tau, k - 1));
    }
  }
  const Eigen::Matrix<double, most_nodes, 1> solution = V.partialPivLu().solve(right);
  PathWeights w{};
  for (int i = 0; i < nodes; ++i) w[i] = solution[i];
  return w;
}

}  // namespace drape::model
