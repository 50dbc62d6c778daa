#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "model/obstacles/polygons.hpp"

namespace drape::model {

/// Where the surface of an obstacle is nearest to a point.
struct Nearest {
  double distance;         ///< [m], negative inside
  Eigen::Vector3d normal;  ///< unit: the direction in which the distance grows, away from the obstacle
};

class PosedMesh;

/// A shape in its own frame.
class Shape {
 public:
  virtual ~Shape() = default;

  /// Where it is nearest; of a shape that deforms, at its first key time.
  virtual Nearest nearest(const Eigen::Vector3d& p) const = 0;

  /// The surface of a mesh, at its first key time; null if the shape is none.
  virtual const PosedMesh* mesh() const { return nullptr; }
};

/// Position [m] and orientation of a rigid body.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  Eigen::Vector3d to_world(const Eigen::Vector3d& p) const { return position + rotation * p; }
  Eigen::Vector3d to_body(const Eigen::Vector3d& x) const { return rotation.conjugate() * (x - position); }

  /// The pose of what has `inner` in this body.
  Pose operator*(const Pose& inner) const { return {to_world(inner.position), rotation * inner.rotation}; }
};

/// A pose at a time [s]. Between key frames positions are interpolated linearly and rotations at constant angular velocity;
/// before the first and after the last one the obstacle is at rest.
struct KeyFrame {
  double t = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< axis times angle, [degrees]
};

/// A shape as users describe it: the values of its keys.
class ShapeRule {
 public:
  virtual ~ShapeRule() = default;

  /// Throws std::invalid_argument, naming the file, if a mesh cannot be read or is not closed.
  virtual std::unique_ptr<const Shape> make() const = 0;

  /// Shapes whose union it is, each to be met for itself: a convex one is never tunnelled. Throws as make() does.
  virtual std::vector<std::unique_ptr<const Shape>> parts() const;

  /// The surface in its own frame, for looking at; of a plane a square with the given side [m]. Throws as make() does.
  virtual Polygons surface(double plane_side) const = 0;

  /// Whether its parts move in its frame or deform; then where one is at a time [s] and its surface in its own frame, of one
  /// that deforms at its first key time.
  virtual bool moves() const { return false; }
  virtual Pose pose_of_part(std::size_t /*part*/, double /*t*/) const { return {}; }
  virtual Polygons surface_of_part(std::size_t /*part*/, double plane_side) const { return surface(plane_side); }
};

template <class Record>
struct Key;

/// A row of the table of shapes; each is defined in a file of its own in shapes/.
struct ShapeKind {
  std::string_view name;
  std::string_view description;
  bool smooth;                                ///< the faces of its surface stand for something round
  std::shared_ptr<ShapeRule> (*create)();     ///< with defaults
  std::span<const Key<ShapeRule>> (*keys)();  ///< beside those of all obstacles, in the order of reading
};

/// All shapes that the model knows.
std::span<const ShapeKind* const> shape_kinds();

/// An obstacle as users describe it.
struct ObstacleRule {
  const ShapeKind* kind = nullptr;
  std::shared_ptr<const ShapeRule> shape;  ///< of this kind
  double friction = 0;                     ///< η, Coulomb's coefficient
  std::vector<KeyFrame> motion{1};         ///< at least one; times ascend
};

/// An obstacle ready to be asked. Copies share the shape.
class Obstacle {
 public:
  /// Throws as ShapeRule::make() does.
  explicit Obstacle(const ObstacleRule& rule) : Obstacle(rule, 0, rule.shape->make()) {}

  /// One of its parts.
  Obstacle(const ObstacleRule& rule, std::size_t index, std::shared_ptr<const Shape> part)
      : shape_(std::move(part)), motion_(rule.motion), friction_(rule.friction), index_(index) {
    if (rule.shape->moves()) figure_ = rule.shape;
  }

  Pose pose(double t) const;
  double friction() const { return friction_; }

  /// In the frame of the obstacle, as Shape has it.
  Nearest nearest(const Eigen::Vector3d& p) const { return shape_->nearest(p); }
  const PosedMesh* mesh() const { return shape_->mesh(); }

  /// That of a mesh that deforms, else null.
  const PosedMesh* deforming() const;

 private:
  std::shared_ptr<const Shape> shape_;
  std::vector<KeyFrame> motion_;
  double friction_;
  std::size_t index_;
  std::shared_ptr<const ShapeRule> figure_;  ///< whose part it is; null if the parts do not move
};

/// All parts of an obstacle. Throws as ShapeRule::make() does.
std::vector<Obstacle> parts_of(const ObstacleRule& rule);

/// Whether it moves, as a whole or in itself.
bool moves(const ObstacleRule& rule);

}  // namespace drape::model
