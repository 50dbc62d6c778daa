// A path's weights are exact for polynomials of its degree, for slow and fast relaxation.

#include "model/memory/path.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drape::verify::path_test {
namespace {

using model::Node;
using model::path_weights;

constexpr double older = 0.7;

double monomial(double tau, int k) { return std::pow(tau, k); }
double derivative(double tau, int k) { return k == 0 ? 0 : k * std::pow(tau, k - 1); }

/// ∫_0^1 θ e^{−θ (1 − τ)} τ^k dτ by Simpson's rule, finer where the exponential is.
double integral(double theta, int k) {
  const int count = 20000;
  const double low = std::max(0.0, 1 - 40 / std::abs(theta)), h = (1 - low) / count;
  double sum = 0;
  for (int i = 0; i <= count; ++i) {
    const double tau = low + h * i, weight = i == 0 || i == count ? 1 : i % 2 ? 4 : 2;
    sum += weight * theta * std::exp(-theta * (1 - tau)) * monomial(tau, k);
  }
  return sum * h / 3;
}

TEST(Path, IsExactForPolynomials) {
  for (const double theta : {1e-9, 1e-3, 0.3, 1.9, 2.1, 30.0, 1e4})
    for (const int nodes : {2, 4, 6}) {
      const model::PathWeights w = path_weights(theta, nodes, older);
      for (int k = 0; k < nodes; ++k) {
        const double value = w[model::at_begin] * monomial(0, k) + w[model::rate_at_begin] * derivative(0, k) +
                             w[model::at_end] * monomial(1, k) + w[model::rate_at_end] * derivative(1, k) +
                             w[model::before] * monomial(-older, k) + w[model::rate_before] * derivative(-older, k);
        const double exact = integral(theta, k);
        EXPECT_NEAR(value, exact, 1e-9 * exact) << "theta = " << theta << ", " << nodes << " nodes, degree " << k;
      }
    }
}

TEST(Path, UsesItsNodesOnly) {
  const model::PathWeights linear = path_weights(0.3, 2, older), cubic = path_weights(0.3, 4, older);
  EXPECT_EQ(linear[model::rate_at_begin], 0);
  EXPECT_EQ(linear[model::rate_at_end], 0);
  EXPECT_NE(cubic[model::rate_at_end], 0);
  EXPECT_EQ(cubic[model::before], 0);
  EXPECT_NE(path_weights(0.3, 6, older)[model::before], 0);
}

}  // namespace
}  // namespace drape::verify::path_test
