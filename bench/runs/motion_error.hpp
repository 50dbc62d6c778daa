#pragma once

#include <vector>

#include "model/cloth.hpp"
#include "reference/reference.hpp"
#include "results/run_record.hpp"
#include "solver/integrator.hpp"

namespace drape::bench {

/// How much a reference moves, at its times, but no less than a scene that moves by a thousandth of its size in the whole run.
struct MotionScale {
  double distance;  ///< largest rms distance from the start [m]
  double velocity;  ///< largest rms velocity [m/s]
  double energy;    ///< largest sum of kinetic energy and change of potential energy [J]
};
MotionScale motion_scale(const model::Cloth& cloth, const reference::Trajectory& trajectory, double size);

double total_energy(const model::Cloth& cloth, double t, const solver::State& y);

/// Distance of a run from a reference of its scene: `states` are the run's at all of the reference's times.
results::MotionErrorRecord motion_error(const std::vector<solver::State>& states, const reference::Reference& reference,
                                        const model::Scene& scene, const model::Cloth& cloth);

}  // namespace drape::bench
