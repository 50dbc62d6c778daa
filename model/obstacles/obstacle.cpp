#include "model/obstacles/obstacle.hpp"

#include <algorithm>
#include <numbers>

#include "model/obstacles/posed_mesh.hpp"

namespace drape::model {
namespace {

Eigen::Quaterniond orientation(const KeyFrame& frame) {
  const double degrees = frame.rotation.norm();
  if (degrees == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, frame.rotation / degrees));
}

Pose pose_of(const KeyFrame& frame) { return {frame.position, orientation(frame)}; }

Pose pose_at(const std::vector<KeyFrame>& motion, double t) {
  const auto next = std::ranges::upper_bound(motion, t, {}, &KeyFrame::t);
  if (next == motion.begin()) return pose_of(motion.front());
  if (next == motion.end()) return pose_of(motion.back());
  const KeyFrame& last = *(next - 1);
  const double part = (t - last.t) / (next->t - last.t);
  return {last.position + part * (next->position - last.position), orientation(last).slerp(part, orientation(*next))};
}

}  // namespace

std::vector<std::unique_ptr<const Shape>> ShapeRule::parts() const {
  std::vector<std::unique_ptr<const Shape>> all;
  all.push_back(make());
  return all;
}

std::vector<Obstacle> parts_of(const ObstacleRule& rule) {
  std::vector<Obstacle> all;
  for (std::unique_ptr<const Shape>& part : rule.shape->parts()) all.emplace_back(rule, all.size(), std::move(part));
  return all;
}

bool moves(const ObstacleRule& rule) { return rule.motion.size() > 1 || rule.shape->moves(); }

const PosedMesh* Obstacle::deforming() const {
  const PosedMesh* surface = mesh();
  return surface != nullptr && surface->moving().moves() ? surface : nullptr;
}

Pose Obstacle::pose(double t) const {
  const Pose whole = pose_at(motion_, t);
  return figure_ ? whole * figure_->pose_of_part(index_, t) : whole;
}

}  // namespace drape::model
