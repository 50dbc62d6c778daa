#include "model/obstacles/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "model/obstacles/obstacle_at_time.hpp"

namespace drape::model {
namespace {

constexpr double pose_step = 1e-4;  ///< over the time of a reaction: of the times whose poses give velocities

std::vector<Obstacle> all_parts(std::span<const ObstacleRule> rules) {
  std::vector<Obstacle> all;
  for (const ObstacleRule& rule : rules) std::ranges::move(parts_of(rule), std::back_inserter(all));
  return all;
}

}  // namespace

Contacts::Contacts(std::span<const ObstacleRule> obstacles, const ContactRule& rule, double gravity, int particles,
                   solver::Counters& work)
    : obstacles_(all_parts(obstacles)),
      distance_(rule.distance),
      relaxation_(rule.relaxation),
      alters_(rule.response == ResponseKind::alteration),
      moment_(pose_step * rule.reaction_time),
      gravity_(gravity),
      answers_(obstacles_.size(), std::vector<Answer>(particles)),
      queries_(work.counter("obstacle_queries", "particles whose distance from an obstacle was computed")) {
  for (const Obstacle& obstacle : obstacles_) {
    const PosedMesh* mesh = obstacle.deforming();
    deforming_.push_back(mesh != nullptr ? std::optional(Deforming{*mesh, *mesh}) : std::nullopt);
  }
}

void Contacts::Deforming::set_times(double t, double h) {
  if (end.time() == t) std::swap(begin, end);  // the next step
  begin.set_time(t);
  end.set_time(t + h);
}

Contacts::Border Contacts::Deforming::border(const Eigen::Vector3d& p, const MaterialPoint& at, double distance) const {
  const Eigen::Vector3d carried = end.pose(at).to_world(begin.pose(at).to_body(p));
  const auto [nearest, there] = end.touch(carried);
  const Eigen::Vector3d border = carried - (nearest.distance - distance) * nearest.normal;
  return {begin.pose(there).to_world(end.pose(there).to_body(border)), border, nearest.normal};
}

void Contacts::find(double t, double h, const solver::State& y, std::vector<solver::Contact>& found) {
  const double fastest = h * y.v.rowwise().norm().maxCoeff() + h * h * gravity_;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const Obstacle& obstacle = obstacles_[k];
    std::optional<Deforming>& deforming = deforming_[k];
    const Pose begin = obstacle.pose(t), end = obstacle.pose(t + h);
    double deformed = 0, way = fastest;
    if (deforming) {
      deforming->set_times(t, h);
      deformed = deforming->begin.moving().way(t);
      way += deforming->begin.moving().way(t + h) - deformed;
    }
    for (int i = 0; i < y.x.rows(); ++i) {
      const Eigen::Vector3d x = y.x.row(i), p = begin.to_body(x);
      const double reach = 2 * (way + (end.to_world(p) - x).norm()) + distance_;
      Answer& last = answers_[k][i];
      const double changed = std::abs(deformed - last.way);
      if (last.known && last.nearest.distance - (p - last.p).norm() - changed > distance_ + reach) continue;
      std::optional<PosedMesh::Touch> touch;
      if (deforming) touch = deforming->begin.touch(p);
      last = {p, touch ? touch->nearest : obstacle.nearest(p), deformed, true};
      ++queries_;
      const double gap = last.nearest.distance - distance_;
      if (!(gap <= reach) || (alters_ && gap >= 0)) continue;
      const Eigen::Vector3d rigid = p - gap * last.nearest.normal;
      const auto [border, border_at_end, outwards] =
          touch ? deforming->border(p, touch->at, distance_) : Border{rigid, rigid, last.nearest.normal};
      const Eigen::Vector3d at_end = end.to_world(border_at_end), normal = end.rotation * outwards;
      found.push_back({.particle = i,
                       .obstacle = static_cast<int>(k),
                       .normal = normal,
                       .gap = gap,
                       .least = at_end.dot(normal) + (1 - relaxation_) * std::min(gap, 0.0),
                       .velocity = (at_end - begin.to_world(border)) / h,
                       .friction = obstacle.friction(),
                       .alters = alters_});
    }
  }
  std::ranges::stable_sort(found, {}, &solver::Contact::particle);
}

void Contacts::near(double t, const Vectors& x, double reach, std::vector<Depth>& found) {
  found.clear();
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const Obstacle& obstacle = obstacles_[k];
    std::optional<Deforming>& deforming = deforming_[k];
    if (deforming) deforming->begin.set_time(t);
    const Pose pose = obstacle.pose(t), later = obstacle.pose(t + moment_);
    for (int i = 0; i < x.rows(); ++i) {
      const Eigen::Vector3d p = pose.to_body(x.row(i));
      std::optional<PosedMesh::Touch> touch;
      if (deforming) touch = deforming->begin.touch(p);
      const Nearest nearest = touch ? touch->nearest : obstacle.nearest(p);
      ++queries_;
      if (nearest.distance >= reach) continue;
      const Eigen::Vector3d surface = p - nearest.distance * nearest.normal;
      Eigen::Vector3d velocity = (later.to_world(surface) - pose.to_world(surface)) / moment_;
      if (touch) velocity += pose.rotation * deforming->begin.velocity(touch->at);
      found.push_back({i, pose.rotation * nearest.normal, distance_ - nearest.distance, velocity, obstacle.friction()});
    }
  }
}

Eigen::VectorXd Contacts::distances(double t, const Vectors& x) const {
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(x.rows(), std::numeric_limits<double>::infinity());
  for (const Obstacle& obstacle : obstacles_) {
    const ObstacleAtTime posed(obstacle, t);
    for (Eigen::Index i = 0; i < x.rows(); ++i) nearest[i] = std::min(nearest[i], posed.nearest(x.row(i)).distance);
  }
  return nearest;
}

}  // namespace drape::model
