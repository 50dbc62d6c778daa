#pragma once

#include "solver/state.hpp"

namespace drape::solver {

/// The implicit stage to which every method reduces: given γ, ax, av find (x, v) with
///
///     x = ax + γ v,     M v = M av + γ f(t, x, v).
struct Stage {
  double gamma;  ///< [s]
  double t;      ///< [s], where f is evaluated
  const Vectors& ax;
  const Vectors& av;
};

}  // namespace drape::solver
