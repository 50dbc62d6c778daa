#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/runs/lag.hpp"
#include "bench/runs/reference_work.hpp"
#include "model/cloth.hpp"
#include "reference/trajectory.hpp"

namespace drape::bench {

/// How a scene really moves: its certified reference at the times asked for and at many between them, from the start to the
/// end.
struct TrueMotion {
  model::Scene scene;
  model::Cloth cloth;
  std::string families;             ///< the two that agree: "cvode-bdf + arkode-esdirk"
  double growth = 0;                ///< largest growth of a small perturbation of the start
  reference::Trajectory motion;     ///< the first state is the start
  reference::Trajectory witness;    ///< the same as the other family has it
  std::vector<double> uncertainty;  ///< [m], root mean square over the particles, at these times
};

/// Throws std::invalid_argument if a scene has what its description for other programs cannot say: several panels, or pins
/// along directions that are not those of axes.
void require_describable(const model::Scene& scene);

/// `times` [s] ascend from 0 to at most the scene's end. `agreement`: as References has it. Throws reference::NotCertified
/// where the families disagree by more, or, as with contact, by more than errors can be measured by; and
/// reference::ReferenceError.
TrueMotion true_motion(const model::Scene& scene, std::span<const double> times, double agreement, const ReferenceWatch& watch);

/// States at times that the motion has, or between them.
std::vector<solver::State> states_at(const reference::Trajectory& motion, std::span<const double> times);

/// The uncertainty at a time [m]: that of the next time that the motion has.
double uncertainty_at(const TrueMotion& truth, double t);

}  // namespace drape::bench
