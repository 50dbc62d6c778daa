#include "model/obstacles/obstacle.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "model/obstacles/mesh_shape.hpp"
#include "model/obstacles/shapes.hpp"

namespace drape::model {
namespace {

std::shared_ptr<const Shape> shape(const ObstacleRule& rule) {
  switch (rule.kind) {
    case ShapeKind::plane: return half_space();
    case ShapeKind::sphere: return sphere(rule.radius);
    case ShapeKind::box: return box(rule.size);
    case ShapeKind::cylinder: return cylinder(rule.radius, rule.height);
    case ShapeKind::mesh: return mesh_shape(rule.file, rule.scale);
  }
  throw std::invalid_argument("unknown shape of an obstacle");
}

Eigen::Quaterniond orientation(const KeyFrame& frame) {
  const double degrees = frame.rotation.norm();
  if (degrees == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, frame.rotation / degrees));
}

Pose pose_of(const KeyFrame& frame) { return {frame.position, orientation(frame)}; }

}  // namespace

Obstacle::Obstacle(const ObstacleRule& rule) : shape_(shape(rule)), motion_(rule.motion), friction_(rule.friction) {}

Pose Obstacle::pose(double t) const {
  const auto next = std::ranges::upper_bound(motion_, t, {}, &KeyFrame::t);
  if (next == motion_.begin()) return pose_of(motion_.front());
  if (next == motion_.end()) return pose_of(motion_.back());
  const KeyFrame& last = *(next - 1);
  const double part = (t - last.t) / (next->t - last.t);
  return {last.position + part * (next->position - last.position), orientation(last).slerp(part, orientation(*next))};
}

}  // namespace drape::model
