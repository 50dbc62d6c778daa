#pragma once

#include "solver/split_ode.hpp"

namespace drape::solver {

/// The stiffest time scales of the equation of motion, linearised.
struct Spectrum {
  double omega_squared = 0;  ///< largest |eigenvalue| of M⁻¹ ∂f/∂x over the free coordinates [1/s²]
  double decay = 0;          ///< largest |eigenvalue| of M⁻¹ ∂f/∂v over the free coordinates [1/s]
};

/// Factor by which an estimated spectrum exceeds the true one, to be safe.
constexpr double spectrum_safety = 1.01;

/// Estimates the spectrum at a state from some tens of evaluations of the force, whose differences approximate products with
/// its Jacobian; overestimates by 1 %. Allocates.
Spectrum spectrum(const SplitOde& ode, double t, const State& y);

/// The largest stable step of the method `verlet` for the mode x'' = −ω² x − c x' [s]; infinite if both vanish, NaN if one is
/// not finite.
double verlet_limit(const Spectrum& spectrum);

/// The largest step with which the classical Runge-Kutta method is stable for all modes with at most this ω and c: 2√2/ω
/// without damping, 2.785/c without springs.
double rk4_limit(const Spectrum& spectrum);

/// The fewest stages, at least 2, with which a step of `rkl2` is stable for all real h λ from −h_decay to 0: (s² + s − 2)/2 is
/// not less   [Meyer, Balsara, Aslam 2014].
double rkl2_stages(double h_decay);

/// The same of `rkc2`: 2/3 (s² − 1) (1 − 2/15 ε) is not less   [Sommeijer, Shampine, Verwer 1998].
double rkc2_stages(double h_decay);

/// The same, at least 3, of `rock2`: 0.807 s² − 1.145 is not less, as measured from 3 to 500 stages.
double rock2_stages(double h_decay);

/// ε of `rkc2`: its stability polynomial stays below 1 − ε/3.
constexpr double rkc2_damping = 2.0 / 13;

}  // namespace drape::solver
