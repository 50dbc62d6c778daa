#include "reference/exact/chain.hpp"

#include <cmath>
#include <numbers>

namespace drape::reference {
namespace {

/// The horizontal force H > 0 with which span(H), which grows with H and is greater than H L/k, is that of the chain: by
/// bisection, as far as numbers go.
template <class Span>
double horizontal_force(const HangingChain& chain, const Span& span) {
  double below = 0, above = chain.modulus * chain.span / chain.length;
  for (;;) {
    const double H = (below + above) / 2;
    if (H <= below || H >= above) return above;
    (span(H) < chain.span ? below : above) = H;
  }
}

/// ∫ (H, V)(1/k + 1/T) dX from 0 to X.
Eigen::Vector2d catenary(const HangingChain& chain, double H, double X) {
  const auto [L, k, f, span] = chain;
  const double V0 = -f * L / 2, V = V0 + f * X;
  return {H * X / k + H / f * (std::asinh(V / H) - std::asinh(V0 / H)),
          (V * V - V0 * V0) / (2 * f * k) + (std::hypot(H, V) - std::hypot(H, V0)) / f};
}

Eigen::MatrixX2d masses(const HangingChain& chain, double H, int springs) {
  const double l = chain.length / springs;
  Eigen::MatrixX2d x = Eigen::MatrixX2d::Zero(springs + 1, 2);
  for (int e = 0; e < springs; ++e) {
    const Eigen::RowVector2d force(H, chain.body_force * l * (e + 0.5 - 0.5 * springs));
    x.row(e + 1) = x.row(e) + l * (1 / chain.modulus + 1 / force.norm()) * force;
  }
  return x;
}

}  // namespace

Eigen::Vector2d hanging_position(const HangingChain& chain, double X) {
  return catenary(chain, horizontal_force(chain, [&](double H) { return catenary(chain, H, chain.length)[0]; }), X);
}

Eigen::MatrixX2d hanging_masses(const HangingChain& chain, int springs) {
  return masses(chain, horizontal_force(chain, [&](double H) { return masses(chain, H, springs)(springs, 0); }), springs);
}

double wave_frequency(const ChainWave& wave) {
  return wave.mode * std::numbers::pi / wave.length * std::sqrt(wave.modulus / wave.density);
}

double wave_frequency(const ChainWave& wave, int springs) {
  const double l = wave.length / springs;
  return 2 / l * std::sqrt(wave.modulus / wave.density) * std::sin(wave.mode * std::numbers::pi * l / (2 * wave.length));
}

double wave_position(const ChainWave& wave, double omega, double X, double t) {
  return X + wave.amplitude * std::sin(wave.mode * std::numbers::pi * X / wave.length) * std::cos(omega * t);
}

}  // namespace drape::reference
