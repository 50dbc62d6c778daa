#pragma once

#include "solver/state.hpp"

namespace drape::solver {

/// The implicit stage to which every method reduces: given γ, ax, av find (x, v) with
///
///     x = ax + γ v,     μ M v = μ M av + γ f(t, x, v).
///
/// f is the force at that state or, if the start x0 is given, the mean force between x0 and 2 x − x0 (SplitOde::mean_excess).
struct Stage {
  double gamma;  ///< [s]
  double t;      ///< [s], where f is evaluated
  const Vectors& ax;
  const Vectors& av;
  double accuracy = 1e-3;          ///< part of the distance between guess and solution that may be left as an error
  double inertia = 1;              ///< μ, for methods whose coefficients in x and in v differ
  const Vectors* start = nullptr;  ///< x0 [m], null for the force at a state
  bool springs = true;             ///< of linear stages: whether f depends on x; if not, x takes part in contacts only
  double residual = 0;  ///< |M (av − v) + γ f| [N s] at which the stage ends instead of its tolerance, if positive
};

}  // namespace drape::solver
