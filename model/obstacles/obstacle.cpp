#include "model/obstacles/obstacle.hpp"

#include <algorithm>
#include <numbers>

namespace drape::model {
namespace {

Eigen::Quaterniond orientation(const KeyFrame& frame) {
  const double degrees = frame.rotation.norm();
  if (degrees == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, frame.rotation / degrees));
}

Pose pose_of(const KeyFrame& frame) { return {frame.position, orientation(frame)}; }

}  // namespace

std::vector<std::unique_ptr<const Shape>> ShapeRule::parts() const {
  std::vector<std::unique_ptr<const Shape>> all;
  all.push_back(make());
  return all;
}

Pose Obstacle::pose(double t) const {
  const auto next = std::ranges::upper_bound(motion_, t, {}, &KeyFrame::t);
  if (next == motion_.begin()) return pose_of(motion_.front());
  if (next == motion_.end()) return pose_of(motion_.back());
  const KeyFrame& last = *(next - 1);
  const double part = (t - last.t) / (next->t - last.t);
  return {last.position + part * (next->position - last.position), orientation(last).slerp(part, orientation(*next))};
}

}  // namespace drape::model
