#pragma once

#include <span>
#include <vector>

#include "model/collision/cloth_surface.hpp"
#include "model/obstacles/surface.hpp"

namespace drape::model {

/// Number of pairs of a triangle of the cloth, whose nodes are at x, N × 3, and one of a body at time t [s] that are nearer
/// than `distance` [m]: the colliding pairs of faces of figure 4.3. The polygons of bodies are split into triangles at their
/// first corner.
int face_pairs(const ClothSurface& surface, std::span<const PosedObstacle> bodies, double t, const Vectors& x, double distance);

/// Such a pair.
struct BodyIntersection {
  int face;  ///< of the cloth
  int body;
};

/// Those that have a point in common, as intersect() has it.
std::vector<BodyIntersection> body_intersections(const ClothSurface& surface, std::span<const PosedObstacle> bodies, double t,
                                                 const Vectors& x);

}  // namespace drape::model
