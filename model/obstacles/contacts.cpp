#include "model/obstacles/contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "model/obstacles/mesh_shape.hpp"
#include "model/obstacles/obstacle_at_time.hpp"

namespace drape::model {
namespace {

constexpr double pose_step = 1e-4;  ///< over the time of a reaction: of the times whose poses give velocities

/// What stands on the border ends steps there except for round-off, and must be found again.
constexpr double touching_border = 1 + 1e-6;  ///< of the distance

std::vector<Obstacle> mesh_parts(const ObstacleRule& rule, std::size_t index) {
  try {
    return mesh_parts_of(rule);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("contact.detection: expected \"half-spaces\" with obstacles[{}] ({}): {}", index,
                                            rule.kind->name, error.what()));
  }
}

}  // namespace

std::vector<Obstacle> met_parts(std::span<const ObstacleRule> obstacles, const ContactRule& rule) {
  const bool by_rays = rule.detection == DetectionKind::ray;
  if (by_rays && rule.response != ResponseKind::constraint && !relocates(rule.response))
    throw std::invalid_argument(
        "contact.detection: expected \"half-spaces\", rays find what is met in a step, which is not what contact.response "
        "asks");
  std::vector<Obstacle> all;
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    std::ranges::move(by_rays ? mesh_parts(obstacles[k], k) : parts_of(obstacles[k]), std::back_inserter(all));
  return all;
}

Contacts::Contacts(std::span<const ObstacleRule> obstacles, const ContactRule& rule, const Eigen::Vector3d& gravity,
                   int particles, solver::Counters& work)
    : obstacles_(met_parts(obstacles, rule)),
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
  if (rule.detection != DetectionKind::ray) return;
  rays_ = &work.counter("rays", "ways of particles on which an obstacle was searched");
  boxes_ = &work.counter("ray_boxes", "boxes around triangles of obstacles that rays looked into");
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
  for (int k = 0; k < std::ssize(obstacles_); ++k) {
    const Ride ride{obstacles_[k].pose(t), obstacles_[k].pose(t + h), h};
    if (rays_ != nullptr)
      find_by_rays(k, ride, y, found);
    else
      find_half_spaces(k, t, ride, y, found);
  }
  std::ranges::stable_sort(found, {}, &solver::Contact::particle);
}

solver::Contact Contacts::contact(int particle, int obstacle, double gap, const Ride& ride, const Border& border) const {
  const Eigen::Vector3d normal = ride.end.rotation * border.normal;
  return {.particle = particle,
          .obstacle = obstacle,
          .normal = normal,
          .gap = gap,
          .least = ride.end.to_world(border.end).dot(normal) + (1 - relaxation_) * std::min(gap, 0.0),
          .velocity = ride.velocity(border),
          .friction = obstacles_[obstacle].friction(),
          .alters = alters_};
}

void Contacts::find_half_spaces(int k, double t, const Ride& ride, const solver::State& y,
                                std::vector<solver::Contact>& found) {
  const Pose &begin = ride.begin, &end = ride.end;
  const double h = ride.h;
  std::optional<Deforming>& deforming = deforming_[k];
  double deformed = 0, way = h * y.v.rowwise().norm().maxCoeff() + h * h * gravity_.norm();
  if (deforming) {
    deforming->set_times(t, h);
    deformed = deforming->begin.moving().way(t);
    way += deforming->begin.moving().way(t + h) - deformed;
  }
  std::atomic<std::int64_t> queries = 0;
  const auto find = [&](int i) -> std::optional<solver::Contact> {
    const Eigen::Vector3d x = y.x.row(i), p = begin.to_body(x);
    const double reach = 2 * (way + (end.to_world(p) - x).norm()) + distance_;
    Answer& last = answers_[k][i];
    const double changed = std::abs(deformed - last.way);
    if (last.known && last.nearest.distance - (p - last.p).norm() - changed > distance_ + reach) return {};
    std::optional<PosedMesh::Touch> touch;
    if (deforming) touch = deforming->begin.touch(p);
    last = {p, touch ? touch->nearest : obstacles_[k].nearest(p), deformed, true};
    ++queries;
    const double gap = last.nearest.distance - distance_;
    if (!(gap <= reach) || (alters_ && gap >= 0)) return {};
    const Eigen::Vector3d rigid = p - gap * last.nearest.normal;
    return contact(i, k, gap, ride,
                   touch ? deforming->border(p, touch->at, distance_) : Border{rigid, rigid, last.nearest.normal});
  };
  collect_(base::threads_for(y.x.rows()), y.x.rows(), found,
           [&](std::int64_t first, std::int64_t last, std::vector<solver::Contact>& part) {
             for (std::int64_t i = first; i < last; ++i)
               if (const auto met = find(static_cast<int>(i))) part.push_back(*met);
           });
  queries_ += queries;
}

void Contacts::find_by_rays(int k, const Ride& ride, const solver::State& y, std::vector<solver::Contact>& found) {
  const Eigen::Vector3d fall = ride.h * ride.h * gravity_;
  for (int i = 0; i < y.x.rows(); ++i) {
    const Eigen::Vector3d x = y.x.row(i), free = x + ride.h * y.v.row(i).transpose() + fall, from = ride.begin.to_body(x);
    if (const auto border = cast(k, from, ride.end.to_body(free)))
      found.push_back(contact(i, k, (from - border->begin).dot(border->normal), ride, *border));
  }
}

/// Where a ball of radius d first meets an obstacle on its way.
std::optional<Contacts::Border> Contacts::cast(int obstacle, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const PosedMesh& mesh = *obstacles_[obstacle].mesh();
  ++*rays_;
  const std::optional<double> part = mesh.first_within(from, to, touching_border * distance_, *boxes_);
  if (!part) return {};
  ++queries_;
  const Eigen::Vector3d at = from + *part * (to - from);
  const auto [distance, normal] = mesh.nearest(at);
  const Eigen::Vector3d border = at - (distance - distance_) * normal;
  return Border{border, border, normal};
}

void Contacts::passed(double t, double h, const Vectors& x0, const Vectors& x1, std::vector<Depth>& found) {
  found.clear();
  for (int k = 0; k < std::ssize(obstacles_); ++k) {
    const Ride ride{obstacles_[k].pose(t), obstacles_[k].pose(t + h), h};
    for (int i = 0; i < x1.rows(); ++i) {
      const Eigen::Vector3d to = ride.end.to_body(x1.row(i));
      const auto border = cast(k, ride.begin.to_body(x0.row(i)), to);
      if (!border) continue;
      const double depth = (border->end - to).dot(border->normal);
      if (depth > 0)
        found.push_back({i, ride.end.rotation * border->normal, depth, ride.velocity(*border), obstacles_[k].friction()});
    }
  }
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
