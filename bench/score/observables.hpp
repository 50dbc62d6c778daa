#pragma once

#include <vector>

#include "bench/score/true_motion.hpp"

namespace drape::bench {

/// What can be compared without comparing particles.
struct Observables {
  double kinetic = 0, potential = 0, total = 0;      ///< energies [J], by our model
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of mass [m]
  double lowest = 0;                                 ///< least height z of a particle [m]
  double stretch = 0;                                ///< largest strain of an edge along weft or warp
};

Observables observe(const model::Scene& scene, const model::Cloth& cloth, double t, const solver::State& y);

/// Observables with what they are uncertain by, of the centre in `centre_distance` [m].
struct UncertainObservables {
  Observables value, uncertainty;
  double centre_distance = 0;
};

/// Those of a reference at some times. Uncertain is what the two families have differed by up to then: at a single time they
/// may agree by chance. `differenced`: velocities are differences of the positions at these times.
std::vector<UncertainObservables> observe(const TrueMotion& truth, std::span<const double> times, bool differenced = false);

/// Replaces the velocities by differences of second order of the positions.
void difference(std::span<const double> times, std::vector<solver::State>& states);

}  // namespace drape::bench
