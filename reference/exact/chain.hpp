#pragma once

#include <Eigen/Dense>

namespace drape::reference {

/// A chain of masses and springs hung by its ends at the same height [Etzmuß 2002, 2.2]. The thesis gives no data: these are
/// those of the built-in scene `chain`. Forces and masses are those of a strip of width 1 m.
struct HangingChain {
  double length = 1;         ///< L [m], at rest
  double modulus = 1e3;      ///< k [N/m]
  double body_force = 9.81;  ///< f [N/m²], downwards
  double span = 0.8;         ///< distance of the ends [m], positive
};

/// (x, z) [m] of the continuum, z upwards, 0 ≤ X ≤ L: the elastic catenary, the solution at rest of (2.11),
///   k (s'' − t') = f e_z, t = s'/|s'|, which with the force (H, V) = (H, f (X − L/2)) through a section, T = |(H, V)|, is
///   x' = H (1/k + 1/T), z' = V (1/k + 1/T); H follows from the span.
Eigen::Vector2d hanging_position(const HangingChain& chain, double X);

/// (x, z) [m] of the masses, (springs + 1) × 2: the same with V constant along a spring, without any error. A single spring
/// cannot sag: it needs a span above L.
Eigen::MatrixX2d hanging_masses(const HangingChain& chain, int springs);

/// A longitudinal standing wave in a chain whose ends are held [Etzmuß 2002, (2.8)]:
///   x = X + a sin(mπX/L) cos ωt, an exact solution of the continuum (2.11) and of the chain, each with its own ω, while
/// no spring is turned inside out, a mπ/L < 1.
struct ChainWave {
  double length = 1;        ///< L [m]
  double modulus = 1e3;     ///< k [N/m]
  double density = 1;       ///< ρ [kg/m²]
  double amplitude = 0.01;  ///< a [m]
  int mode = 1;             ///< m
};

/// ω = (mπ/L) √(k/ρ) [1/s] of the continuum.
double wave_frequency(const ChainWave& wave);

/// ω = (2/l) √(k/ρ) sin(mπl/2L) [1/s] of a chain of springs of length l = L/springs, 0 < m < springs.
double wave_frequency(const ChainWave& wave, int springs);

/// x [m] at the time t [s] with the frequency ω.
double wave_position(const ChainWave& wave, double omega, double X, double t);

}  // namespace drape::reference
