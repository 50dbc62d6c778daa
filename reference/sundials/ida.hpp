#pragma once

#include "reference/trajectory.hpp"

namespace drape::reference {

/// A trajectory with the forces of the pins.
struct ConstrainedTrajectory {
  Trajectory trajectory;
  std::vector<solver::Vectors>
      reactions;  ///< N × 3 [N] at every time, of the pins on their particles; 0 where nothing is pinned
};

/// Solves the equation of motion in residual form with IDA: BDF of orders 1 to 5 with variable step, Newton's method with the
/// exact sparse Jacobian factorised by KLU [Hindmarsh et al. 2005, SUNDIALS].
///
/// The unknowns are all positions, velocities, and one reaction λ for each of the pinned coordinates:
///   x' - v = 0,  M v' - f(t, x, v) = 0                                in the free coordinates,
///   x - x0 - w (t - t0) = 0,  v - w = 0,  f(t, x, v) + λ = 0          in the pinned ones, which move with the velocity w.
/// The latter are algebraic and of index 1, and are left out of the error test. Arguments and exceptions as for cvode();
/// counts its work under "ida/".
ConstrainedTrajectory ida(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                          const SolveOptions& options = {});

}  // namespace drape::reference
