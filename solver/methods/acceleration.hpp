#pragma once

#include "solver/step.hpp"

namespace drape::solver {

/// a = M⁻¹ f(t, y), 0 in pinned coordinates.
inline void acceleration(const SplitOde& ode, double t, const State& y, Vectors& a) {
  ode.force(t, y.x, y.v, a);
  filter(ode.pins, a);
  a = ode.mass.cwiseInverse().asDiagonal() * a;
}

/// Sets f̂ to h² ∂a/∂t at the start, by a central difference: its error, in h⁴ beside f̂, is beyond the orders of all methods
/// here. Overwrites av.
inline void find_time_derivative(Step& s) {
  constexpr double part = 1e-2;  // less would be lost in round-off
  Vectors &later = s.scratch.f_hat, &earlier = s.scratch.av;
  acceleration(s.ode, s.t + part * s.h, s.y0(), later);
  acceleration(s.ode, s.t - part * s.h, s.y0(), earlier);
  later = s.h / (2 * part) * (later - earlier);
}

}  // namespace drape::solver
