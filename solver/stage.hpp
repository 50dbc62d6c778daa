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
  double accuracy = 1e-3;  ///< part of the distance between guess and solution that may be left as an error
  double residual = 0;     ///< |M (av − v) + γ f| [N s] at which the stage ends instead of its tolerance, if positive
};

}  // namespace drape::solver
