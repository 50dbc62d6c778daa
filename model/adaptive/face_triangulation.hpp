#pragma once

#include <array>
#include <functional>
#include <vector>

#include "model/adaptive/insertion.hpp"
#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// A triangle of a sheet before its points are inserted.
struct BareFace {
  std::array<int, 3> nodes;
  Corners corners;  ///< where they are [m]
};

/// Triangles between the corners and points of a face that keep its segments and border, by constrained Delaunay triangulation
/// in its plane with exact predicates [Etzmuß 2002, 5.3; CGAL]. `position`: where the particle with a number is [m]. Calls
/// add(particle) for each one where segments cross, which returns its number.
std::vector<std::array<int, 3>> triangulate(const BareFace& face, const HitFace& hit,
                                            const std::function<Eigen::Vector3d(int)>& position,
                                            const std::function<int(const VirtualParticle&)>& add);

}  // namespace drape::model
