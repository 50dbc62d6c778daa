#pragma once

#include <memory>
#include <vector>

#include "model/adaptive/body_surface.hpp"
#include "model/adaptive/refined_sheet.hpp"
#include "model/adaptive/virtual_particles.hpp"
#include "model/garment.hpp"

namespace drape::model {

/// Refines a sheet around obstacles at any time, for looking at.
class SheetRefinement {
 public:
  /// Throws std::invalid_argument as BodySurface and VirtualParticles do.
  SheetRefinement(const Garment& garment, std::span<const ObstacleRule> obstacles);

  /// `x`: positions of the nodes at a time [s], N × 3 [m].
  RefinedSheet at(double t, const Vectors& x);

  /// That as triangles.
  Polygons polygons(double t, const Vectors& x);

 private:
  std::unique_ptr<solver::Counters> work_;
  BodySurface obstacles_;
  std::unique_ptr<VirtualParticles> search_;  ///< null if no obstacle has edges
  EdgeMesh sheet_;
  std::vector<Eigen::Vector3d> vertices_, velocities_;
};

/// Throws std::invalid_argument as BodySurface and met_parts do if a scene asks for virtual particles or rays on what is no
/// closed body.
void require_bodies(const Scene& scene);

}  // namespace drape::model
