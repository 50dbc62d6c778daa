#pragma once

#include "solver/step.hpp"

namespace drape::solver {

/// a = M⁻¹ f(t, y), 0 in pinned coordinates.
inline void acceleration(const SplitOde& ode, double t, const State& y, Vectors& a) {
  ode.force(t, y.x, y.v, a);
  filter(ode.pins, a);
  a = ode.mass.cwiseInverse().asDiagonal() * a;
}

}  // namespace drape::solver
