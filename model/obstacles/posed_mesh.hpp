#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "model/obstacles/moving_mesh.hpp"
#include "model/obstacles/obstacle.hpp"
#include "model/obstacles/triangle_hierarchy.hpp"

namespace drape::model {

/// A point that moves with a triangle.
struct MaterialPoint {
  int triangle;
  Eigen::Vector3d weights;  ///< barycentric coordinates
};

/// A mesh where it is at a time. Copies are set to times of their own. The nearest triangle is found by a bounding-volume
/// hierarchy, the sign of the distance by angle-weighted pseudo-normals [Bærentzen, Aanæs 2005].
class PosedMesh {
 public:
  /// At the first key time.
  explicit PosedMesh(std::shared_ptr<const MovingMesh> mesh);

  const MovingMesh& moving() const { return *moving_; }

  double time() const { return t_; }  ///< [s]

  /// Fits the hierarchy to the vertices at a time [s]. Allocates nothing.
  void set_time(double t);

  struct Touch {
    Nearest nearest;
    MaterialPoint at;
  };

  Nearest nearest(const Eigen::Vector3d& p) const;
  Touch touch(const Eigen::Vector3d& p) const;

  /// As TriangleHierarchy.
  std::optional<double> first_within(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double distance,
                                     std::int64_t& boxes) const {
    return hierarchy_.first_within(from, to, distance, boxes);
  }

  /// Place of a point and orientation of its triangle.
  Pose pose(const MaterialPoint& at) const;

  /// Velocity of a point [m/s], after this time where that is a key time.
  Eigen::Vector3d velocity(const MaterialPoint& at) const;

 private:
  Nearest nearest(const Eigen::Vector3d& p, const TriangleHierarchy::Found& found) const;

  std::shared_ptr<const MovingMesh> moving_;
  double t_, within_;  ///< its time, and the same between the first and the last key time
  TriangleMesh mesh_;  ///< at this time
  TriangleHierarchy hierarchy_;
};

}  // namespace drape::model
