#pragma once

#include <Eigen/Core>
#include <optional>

#include "model/obstacles/obstacle.hpp"
#include "model/obstacles/posed_mesh.hpp"

namespace drape::model {

/// An obstacle where it is at a time, in the frame of the scene.
class ObstacleAtTime {
 public:
  ObstacleAtTime(const Obstacle& obstacle, double t) : obstacle_(obstacle) {
    if (obstacle.deforming() != nullptr) mesh_.emplace(*obstacle.deforming());
    set_time(t);
  }

  /// t [s].
  void set_time(double t) {
    pose_ = obstacle_.pose(t);
    if (mesh_) mesh_->set_time(t);
  }

  Nearest nearest(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d p = pose_.to_body(x);
    const auto [distance, normal] = mesh_ ? mesh_->nearest(p) : obstacle_.nearest(p);
    return {distance, pose_.rotation * normal};
  }

 private:
  Obstacle obstacle_;
  std::optional<PosedMesh> mesh_;  ///< if it deforms
  Pose pose_;
};

}  // namespace drape::model
