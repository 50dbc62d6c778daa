#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "model/adaptive/edge_mesh.hpp"
#include "model/adaptive/insertion.hpp"
#include "model/collision/box_tree.hpp"
#include "model/obstacles/triangle_mesh.hpp"
#include "solver/counters.hpp"
#include "solver/state.hpp"

namespace drape::model {

/// Finds the virtual particles of a sheet and the obstacles around it [Etzmuß 2002, 5.3]. The front of the sheet, the side of
/// its normals, is away from the obstacles: what passes through a face to its front is projected onto the face.
///
/// The search begins at triangles of the obstacle through which faces of the sheet pass, and goes on over the surface of the
/// obstacle from there, prism by prism. So its cost grows with what it finds, and an obstacle on whose far side the sheet lies
/// (step 5, fig. 5.9) is never reached. The printed test, a ray from a point to its image, cannot decide that: from an edge
/// where the obstacle begins to overhang the ray leaves it at once, whether the sheet passes through it or lies below.
///
/// What overhangs is taken to the front as well. Limit: a node of the sheet may be below it, which no triangulation of the
/// faces with their nodes avoids.
class VirtualParticles {
 public:
  /// `faces`: triangles of the sheet, whose nodes are once at `places`, N × 3 [m]; `obstacle`: closed bodies that do not touch.
  /// Throws std::invalid_argument in one line unless EdgeMesh accepts the faces, and the obstacle is closed and its triangles
  /// have areas and enclose a volume.
  VirtualParticles(std::span<const std::array<int, 3>> faces, const solver::Vectors& places, const TriangleMesh& obstacle,
                   solver::Counters& work);

  const EdgeMesh& sheet() const { return sheet_; }
  const EdgeMesh& obstacle() const { return obstacle_; }

  /// `x`: where the nodes are, N × 3; `vertices`: where those of the obstacle are, both at the end of the step [m].
  Insertion find(const solver::Vectors& x, std::span<const Eigen::Vector3d> vertices);

 private:
  void move_obstacle(std::span<const Eigen::Vector3d> vertices);

  EdgeMesh sheet_, obstacle_;
  BoxTree sheet_tree_, obstacle_tree_;
  std::vector<Eigen::Vector3d> vertices_;          ///< of the obstacle where it was last; empty before
  std::vector<Corners> body_;                      ///< its triangles there
  std::vector<Eigen::Vector3d> normals_;           ///< of these, unit
  std::pmr::unsynchronized_pool_resource memory_;  ///< what a search needs, kept for the next
  std::int64_t &pairs_, &steps_;
};

}  // namespace drape::model
