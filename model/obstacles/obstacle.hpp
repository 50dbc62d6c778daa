#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

namespace drape::model {

/// Where the surface of an obstacle is nearest to a point.
struct Nearest {
  double distance;         ///< [m], negative inside
  Eigen::Vector3d normal;  ///< unit: the direction in which the distance grows, away from the obstacle
};

/// A rigid shape in its own frame.
class Shape {
 public:
  virtual ~Shape() = default;
  virtual Nearest nearest(const Eigen::Vector3d& p) const = 0;
};

/// Position [m] and orientation of a rigid body.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  Eigen::Vector3d to_world(const Eigen::Vector3d& p) const { return position + rotation * p; }
  Eigen::Vector3d to_body(const Eigen::Vector3d& x) const { return rotation.conjugate() * (x - position); }
};

/// A pose at a time [s]. Between key frames positions are interpolated linearly and rotations at constant angular velocity;
/// before the first and after the last one the obstacle is at rest.
struct KeyFrame {
  double t = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< axis times angle, [degrees]
};

enum class ShapeKind {
  plane,     ///< the half-space below z = 0
  sphere,    ///< `radius`
  box,       ///< `size`, centred
  cylinder,  ///< `radius`, `height`, centred, axis along z: a round table
  mesh,      ///< a closed triangle mesh from `file`, times `scale`
};

/// An obstacle as users describe it.
struct ObstacleRule {
  ShapeKind kind = ShapeKind::plane;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< [m]
  double radius = 1;                               ///< [m]
  double height = 1;                               ///< [m]
  std::string file = {};
  double scale = 1;
  double friction = 0;              ///< η, Coulomb's coefficient
  std::vector<KeyFrame> motion{1};  ///< at least one; times ascend
};

/// An obstacle ready to be asked. Copies share the shape.
class Obstacle {
 public:
  /// Throws std::invalid_argument, naming the file, if a mesh cannot be read or is not closed.
  explicit Obstacle(const ObstacleRule& rule);

  Pose pose(double t) const;
  double friction() const { return friction_; }

  /// In the frame of the obstacle.
  Nearest nearest(const Eigen::Vector3d& p) const { return shape_->nearest(p); }

 private:
  std::shared_ptr<const Shape> shape_;
  std::vector<KeyFrame> motion_;
  double friction_;
};

}  // namespace drape::model
