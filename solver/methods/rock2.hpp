#pragma once

#include <vector>

#include "solver/methods/stabilised.hpp"

namespace drape::solver {

/// The stability polynomial of `rock2` with s stages, R(z) = w(a + d z) P(a + d z), R(0) = 1, for
///
///     w(x) = ((x − c)² + g²) / ((a − c)² + g²)   and   P of degree s − 2, orthogonal to those below for the weight w²/√(1 −
///     x²).
///
/// R'(0) = R''(0) = 1, and |R| ≤ 0.95 for x from −1 to 1   [Abdulle, Medovikov 2001]. Their tables are not used: the recurrence
/// of P comes from Gauss-Chebyshev quadrature, which is exact here; a, d and g from the three conditions; and c = 1 − 3/s²,
/// near which the interval is longest.
struct Rock2Polynomial {
  explicit Rock2Polynomial(int stages);  ///< 3 or more

  double a, d;
  double sigma, tau;                  ///< w = 1 + 2 σ z + τ z²
  double third;                       ///< R'''(0)
  std::vector<StageWeights> weights;  ///< of P normalised to 1 at z = 0, without γ̃ and the part of Y_0

  /// Up to which −z the polynomial is at most 1.
  double interval() const { return (1 + a) / d; }
};

/// The stages that P costs and the two that w costs.
void rock2(Step& s, const Rock2Polynomial& polynomial);

}  // namespace drape::solver
