#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/scene.hpp"

namespace drape::bench {

/// What a force says of its derivatives, against central differences, along a direction in which every particle moves. Errors
/// are the largest in a component, over the largest component of derivative and force.
struct ForceCheck {
  std::string name;
  std::optional<double> energy = {};  ///< of −<f, dx> as that of the energy, over |f| |dx|; none: it has no energy
  double by_x = 0, by_v = 0;          ///< of its exact Jacobian times dx, and times dv

  /// Whether they are those of differences of double precision.
  bool agrees() const;
};

/// All forces of a scene, of panels the worst, except those that remember the motion. The sheet is at its start, deformed by a
/// quarter of the shortest edge. Throws as compile.
std::vector<ForceCheck> check_forces(const model::Scene& scene);

}  // namespace drape::bench
