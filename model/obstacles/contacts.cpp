#include "model/obstacles/contacts.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

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
      moment_(pose_step * rule.reaction_time),
      gravity_(gravity),
      answers_(obstacles_.size(), std::vector<Answer>(particles)),
      queries_(work.counter("obstacle_queries", "particles whose distance from an obstacle was computed")) {}

void Contacts::find(double t, double h, const solver::State& y, std::vector<solver::Contact>& found) {
  const double way = h * y.v.rowwise().norm().maxCoeff() + h * h * gravity_;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const Obstacle& obstacle = obstacles_[k];
    const Pose begin = obstacle.pose(t), end = obstacle.pose(t + h);
    for (int i = 0; i < y.x.rows(); ++i) {
      const Eigen::Vector3d x = y.x.row(i), p = begin.to_body(x);
      const double reach = 2 * (way + (end.to_world(p) - x).norm()) + distance_;
      Answer& last = answers_[k][i];
      if (last.known && last.nearest.distance - (p - last.p).norm() > distance_ + reach) continue;
      last = {p, obstacle.nearest(p), true};
      ++queries_;
      const double gap = last.nearest.distance - distance_;
      if (!(gap <= reach)) continue;
      const Eigen::Vector3d border = p - gap * last.nearest.normal, at_end = end.to_world(border);
      const Eigen::Vector3d normal = end.rotation * last.nearest.normal;
      found.push_back({.particle = i,
                       .obstacle = static_cast<int>(k),
                       .normal = normal,
                       .gap = gap,
                       .least = at_end.dot(normal) + (1 - relaxation_) * std::min(gap, 0.0),
                       .velocity = (at_end - begin.to_world(border)) / h,
                       .friction = obstacle.friction()});
    }
  }
  std::ranges::stable_sort(found, {}, &solver::Contact::particle);
}

void Contacts::inside(double t, const Vectors& x, std::vector<Depth>& found) const {
  found.clear();
  for (const Obstacle& obstacle : obstacles_) {
    const Pose pose = obstacle.pose(t), later = obstacle.pose(t + moment_);
    for (int i = 0; i < x.rows(); ++i) {
      const Eigen::Vector3d p = pose.to_body(x.row(i));
      const Nearest nearest = obstacle.nearest(p);
      ++queries_;
      if (nearest.distance >= distance_) continue;
      const Eigen::Vector3d surface = p - nearest.distance * nearest.normal;
      found.push_back({i, pose.rotation * nearest.normal, distance_ - nearest.distance,
                       (later.to_world(surface) - pose.to_world(surface)) / moment_, obstacle.friction()});
    }
  }
}

Eigen::VectorXd Contacts::distances(double t, const Vectors& x) const {
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(x.rows(), std::numeric_limits<double>::infinity());
  for (const Obstacle& obstacle : obstacles_) {
    const Pose pose = obstacle.pose(t);
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      nearest[i] = std::min(nearest[i], obstacle.nearest(pose.to_body(x.row(i))).distance);
  }
  return nearest;
}

}  // namespace drape::model
