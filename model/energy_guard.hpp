#pragma once

#include "model/cloth.hpp"
#include "solver/integrator.hpp"

namespace drape::model {

/// Tells runs that are unstable from those that are wrong but bounded: by the sum of kinetic and elastic energy, which the
/// scene itself limits.
class EnergyGuard {
 public:
  /// So many times the limit is unstable: forces that are no gradient (wind apart: projected bending, the printed forms) and
  /// obstacles that push particles out of themselves may honestly add a little.
  static constexpr double tolerated = 10;

  /// Keeps what it needs of the scene and of the cloth that it was compiled to.
  EnergyGuard(const Scene& scene, const Cloth& cloth);

  /// The most kinetic and elastic energy [J] that the scene can have at a time: √(2E) grows by no more than the outer forces
  /// allow, d√(2E)/dt ≤ |F|/√M, since elastic energy is never negative and damping only takes. Scenes that move particles may
  /// in addition have what their pins stretch springs by, and twice the velocity of obstacles and pins in every particle.
  double limit(double t) const;

  /// Kinetic and elastic energy [J] of a state, given the kinetic energy and the potential one, gravity's included.
  double energy(double kinetic, double potential, const solver::Vectors& x) const;

  bool exceeded(double t, double energy) const { return !(energy <= tolerated * limit(t)); }

 private:
  solver::Vectors weight_;  ///< [N]
  double root_start_ = 0;   ///< √(2E) at t = 0
  double root_growth_ = 0;  ///< |F|/√M of gravity and wind
  double root_moved_ = 0;   ///< √M times the velocity of what is moved
  double stretch_ = 0;      ///< ½ k (w/l)² times the area: grows with t² [J/s²]
};

/// solver::integrate, but a run whose energy exceeds the guard's limit, or is no number, ends there as `unstable`; its last
/// good time is that of the step before.
solver::RunResult integrate(solver::Integrator& integrator, const solver::SplitOde& ode, const EnergyGuard& guard, double t_end,
                            double h, const solver::Observer& observer = {});

}  // namespace drape::model
