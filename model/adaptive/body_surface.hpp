#pragma once

#include <span>
#include <vector>

#include "model/obstacles/surface.hpp"
#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// The surfaces of obstacles as one mesh of closed bodies. Planes are left out: no face passes through a plane unless a
/// particle does.
class BodySurface {
 public:
  /// Throws std::invalid_argument, in one line that names the key of the obstacle, unless its surface is closed, its triangles
  /// have areas and enclose a volume, and none of its bodies touches another one where the motion begins: by exact predicates.
  explicit BodySurface(std::span<const ObstacleRule> obstacles);

  bool empty() const { return mesh_.triangles.empty(); }

  /// Where the obstacles are at first.
  const TriangleMesh& mesh() const { return mesh_; }

  /// Sets the positions of the vertices at a time [s], and their velocities after it, which are empty if nothing moves [m],
  /// [m/s].
  void place(double t, std::vector<Eigen::Vector3d>& positions, std::vector<Eigen::Vector3d>& velocities) const;

 private:
  void add(const ObstacleRule& rule);
  void place(double t, std::vector<Eigen::Vector3d>& positions) const;

  std::vector<PosedObstacle> bodies_;
  TriangleMesh mesh_;
  bool moves_ = false;
};

}  // namespace drape::model
