#pragma once

#include "solver/split_ode.hpp"

namespace drape::solver {

/// The stiffest time scales of the equation of motion, linearised.
struct Spectrum {
  double omega_squared = 0;  ///< largest |eigenvalue| of M⁻¹ ∂f/∂x over the free coordinates [1/s²]
  double decay = 0;          ///< largest |eigenvalue| of M⁻¹ ∂f/∂v over the free coordinates [1/s]
};

/// Estimates the spectrum at a state from some tens of evaluations of the force, whose differences approximate products with
/// its Jacobian; overestimates by 1 %, to be safe. Allocates.
Spectrum spectrum(const SplitOde& ode, double t, const State& y);

/// The largest stable step of the method `verlet` for the mode x'' = −ω² x − c x' [s]; infinite if both vanish, NaN if one is
/// not finite.
double verlet_limit(const Spectrum& spectrum);

}  // namespace drape::solver
