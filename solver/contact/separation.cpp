#include "solver/contact/separation.hpp"

#include <algorithm>
#include <limits>

#include "solver/base/decompositions.hpp"
#include "solver/base/disjoint_sets.hpp"
#include "solver/base/stopwatch.hpp"
#include "solver/contact/rigid_body.hpp"
#include "solver/filter.hpp"

namespace drape::solver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int wanting_rounds = 5;   ///< for the wanted distance
constexpr int pushing_rounds = 20;  ///< of impulses; pairs that need more move as one body
constexpr int most_rounds = 100;
constexpr int pushing_sweeps = 30;  ///< over all pairs in a round
constexpr double regained = 0.05;   ///< part of what is missing of the distance that pairs gain in a step
constexpr double turning = 0.05;    ///< over that of free particles: a pair of less gain would be turned as a whole
constexpr double enough = 1e-3;     ///< part of the distance by which a sweep moves nothing any more

}  // namespace

Separation::Separation(const SplitOde& ode)
    : ode_(ode),
      lightness_(static_cast<std::size_t>(ode.particles())),
      joined_(ode.particles()),
      pushed_(
          ode.work->counter("separated_pairs", "pairs of the cloth that were pushed apart after a step, summed over rounds")),
      rigid_(ode.work->counter("rigid_particles", "particles that moved with others as one body after a step")) {
  for (int i = 0; i < ode.particles(); ++i) lightness_[i] = 1 / ode.mass[i];
  for (const Pin& pin : ode.pins) lightness_[pin.particle] = 0;
}

/// Returns by how much it changes the motion.
double Separation::Push::give(int direction, double impulse, Vectors& x) {
  given[direction] += impulse;
  for (int k = 0; k < 4; ++k) x.row(cloth.particles[k]) += impulse * way[direction][k];
  return std::abs(impulse) * gain[direction];
}

double Separation::Push::push(Vectors& x) {
  const double missing = aim - points.along_normal(cloth.particles, x);
  return give(0, std::max(missing / gain[0], -given[0]), x);
}

/// Friction that would undo how the pair slides in the step, within Coulomb's cone.
void Separation::Push::rub(Vectors& x) {
  const double most = friction * given[0], across = std::max(gain[1], gain[2]);
  if (across < turning * free) return;
  const auto stop = [&](int c) { return given[c] - (motion[c].along(cloth.particles, x) - before[c]) / across; };
  Eigen::Vector2d stops(stop(1), stop(2));
  if (const double size = stops.norm(); size > most) stops *= most / size;
  for (const int c : {1, 2}) give(c, stops[c - 1] - given[c], x);
}

/// Impulses that change x1 by h times the change of v1 keep angular momentum if they have no torque about x1 − h v1.
Separation::Push Separation::push_of(const PairContact& pair, double part, const Vectors& x0, const Vectors& arms) const {
  const double distance = part * pair.keeps;
  Push push;
  push.cloth = cloth_part(pair, pair.touch, ode_.particles(), ode_.pairs->bodies());
  push.points = pair.touch;
  push.friction = pair.friction;
  push.aim = distance * (1 + enough);
  if (pair.begin.distance < distance) push.aim = pair.begin.distance + regained * (distance - pair.begin.distance);
  push.aim -= (push.cloth.body + push.cloth.way).dot(pair.touch.normal);
  const auto& [particles, of_body, body, way] = push.cloth;
  const bool held = push.cloth.meets_body() || std::ranges::any_of(particles, [&](int i) { return lightness_[i] == 0; });
  push.motion = held ? held_motion_of(push.points, of_body) : motion_of(push.points, particles, ode_.mass, arms);
  for (int k = 0; k < 4; ++k) {
    if (of_body[k]) push.points.weights[k] = 0;
    push.free += lightness_[particles[k]] * push.points.weights[k] * push.points.weights[k];
  }
  const Eigen::Vector3d carried = axes_of(pair.touch.normal).transpose() * way;
  for (int c = 0; c < 3; ++c) {
    push.before[c] = push.motion[c].along(particles, x0) - carried[c];
    for (int k = 0; k < 4; ++k) {
      push.way[c][k] = lightness_[particles[k]] * push.motion[c].of[k];
      push.gain[c] += push.motion[c].of[k].dot(push.way[c][k]);
    }
  }
  return push;
}

/// Particles that are deep already need not come out.
void Separation::bound(std::span<const Contact> contacts, const Vectors& x1) {
  bounds_.clear();
  for (const Contact& contact : contacts)
    if (lightness_[contact.particle] > 0)
      bounds_.push_back(
          {contact.particle, contact.normal, std::min(contact.least, x1.row(contact.particle).dot(contact.normal))});
}

void Separation::push_out(Vectors& x1) {
  for (Bound& bound : bounds_) {
    const double way = std::max(bound.least - x1.row(bound.particle).dot(bound.normal), -bound.given);
    bound.given += way;
    x1.row(bound.particle) += way * bound.normal;
  }
}

/// By Gauss and Seidel's iteration over all pairs; impulses that are not needed any more are taken back.
void Separation::push_apart(const Vectors& x0, const Vectors& arms, double part, Vectors& x1) {
  pushes_.clear();
  double least = std::numeric_limits<double>::infinity();
  for (const PairContact& pair : found_) {
    const Push push = push_of(pair, part, x0, arms);
    if (push.gain[0] <= turning * push.free) continue;
    pushes_.push_back(push);
    least = std::min(least, part * pair.keeps);
  }
  for (Bound& bound : bounds_) bound.given = 0;
  double most = least;
  for (int sweep = 0; sweep < pushing_sweeps && most > enough * least; ++sweep) {
    most = 0;
    for (Push& push : pushes_) most = std::max(most, push.push(x1));
    push_out(x1);
  }
  if (!ode_.pairs->rubs()) return;
  for (Push& push : pushes_) push.rub(x1);  // once: where it presses pairs together, more of it would never end
  push_out(x1);
}

/// Moves sets of pairs that still meet as one body, which has their momentum and, for small angles, angular momentum.
void Separation::move_rigidly(const Vectors& x0, Vectors& x1) {
  for (const PairContact& pair : found_) {
    const auto& [particles, of_body, body, way] = cloth_part(pair, pair.touch, ode_.particles(), ode_.pairs->bodies());
    for (int k = 1; k < 4; ++k) joined_.join(particles[0], particles[k]);
  }
  std::vector<std::vector<int>> bodies(lightness_.size());
  for (int i = 0; i < ode_.particles(); ++i) bodies[joined_.root(i)].push_back(i);
  // Pinned particles are much heavier than the others of their body, so that these follow them.
  constexpr double heavy = 1e6;
  const auto mass = [&](int i) { return lightness_[i] > 0 ? ode_.mass[i] : heavy * ode_.mass[i]; };
  for (const std::vector<int>& particles : bodies) {
    if (particles.size() < 2) continue;
    rigid_ += std::ssize(particles);
    const RigidBody body = rigid_body(particles, mass, x0);
    Vector3d way = Vector3d::Zero(), spin = Vector3d::Zero();
    for (const int i : particles) way += mass(i) / body.mass * (x1.row(i) - x0.row(i)).transpose();
    for (const int i : particles)
      spin += mass(i) * (x0.row(i).transpose() - body.centre).cross((x1.row(i) - x0.row(i)).transpose());
    const Vector3d turn = base::pseudo_inverse(body.inertia) * spin;
    const double angle = turn.norm();
    const Matrix3d rotation =
        angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Matrix3d(Matrix3d::Identity());
    for (const int i : particles)
      if (lightness_[i] > 0) x1.row(i) = body.centre + way + rotation * (x0.row(i).transpose() - body.centre);
  }
}

bool Separation::separate(double t, const State& y0, double h, const Distances& distances, std::span<const Contact> contacts,
                          State& y1) {
  x1_ = y1.x;
  joined_ = base::DisjointSets(ode_.particles());
  arms_ = y1.x - h * y1.v;
  bound(contacts, x1_);
  ode_.pairs->begin(t, h);
  for (int round = 0; round < most_rounds; ++round) {
    const double part = round < wanting_rounds ? distances.wanted : distances.least;
    ode_.pairs->find(y0.x, x1_, part, found_);
    if (found_.empty()) {
      if (round > 0) {
        y1.v += (x1_ - y1.x) / h;
        y1.x = x1_;
      }
      return true;
    }
    const base::Stopwatch stopwatch(ode_.response_ms);
    if (round < pushing_rounds) {
      pushed_ += std::ssize(found_);
      push_apart(y0.x, arms_, part, x1_);
    } else {
      move_rigidly(y0.x, x1_);
    }
  }
  return false;
}

}  // namespace drape::solver
