#include "bench/studies/contact/contact_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/runs/contact_observer.hpp"
#include "model/collision/body_faces.hpp"

namespace drape::bench {
namespace {

Eigen::Vector3d momentum_of(const solver::SplitOde& ode, const solver::Vectors& v) {
  return (ode.mass.asDiagonal() * v).colwise().sum();
}

}  // namespace

void ContactWatch::begin(const model::Scene& scene, const model::Cloth& cloth, const solver::State& start) {
  const bool first = cloth_ == nullptr;
  cloth_ = &cloth;
  const bool still = !cloth.ode.step_forces &&
                     std::ranges::all_of(cloth.ode.pins, [](const solver::Pin& pin) { return pin.prescribed().isZero(0); }) &&
                     std::ranges::none_of(scene.obstacles, &model::moves);
  energies_.reset();
  if (still) {
    findings_.energy_rise = findings_.energy_rise.value_or(0);
    energies_ = Energies{solver::stored_energy(cloth.ode, cloth.begin, start), std::numeric_limits<double>::infinity()};
    see_energy(cloth.begin, start);
  }
  force_ = force(cloth.begin, start);
  momentum_ = momentum_of(cloth.ode, start.v);
  holds_ = holds_ || !cloth.ode.pins.empty();
  self_.emplace(model::ClothSurface(*cloth.garment), unused_);  // seams merge nodes
  if (!first) return;
  off_.setZero();
  thickness_ = scene.contact.thickness;
  constexpr double no_plane = 0;  // no face passes through a plane unless a particle does
  for (const model::ObstacleRule& rule : scene.obstacles) bodies_.emplace_back(rule, no_plane);
  see(cloth.begin, start);
}

void ContactWatch::observe(const solver::StepReport& step) {
  see(step.t, step.y);
  findings_.pairs.push_back(static_cast<int>(near_.size()));
  if (energies_) see_energy(step.t, step.y);
  const Eigen::Vector3d force_before = force_, momentum_before = momentum_;
  force_ = force(step.t, step.y);
  momentum_ = momentum_of(cloth_->ode, step.y.v);
  const Eigen::Vector3d given = step.h / 2 * (force_before + force_);
  off_ += momentum_ - momentum_before - given - step.contacts.impulse;
  given_ += given.norm();
  if (!holds_ && given_ > 0) findings_.momentum = off_.norm() / given_;
}

void ContactWatch::see(double t, const solver::State& y) {
  findings_.intersecting += self_->intersections(y.x).empty() ? 0 : 1;
  findings_.in_bodies += cloth_->contacts && cloth_->contacts->distances(t, y.x).minCoeff() <= 0 ? 1 : 0;
  findings_.through_bodies += model::body_intersections(self_->surface(), bodies_, t, y.x).empty() ? 0 : 1;
  near_.clear();
  if (thickness_ == 0) return;
  self_->near(y.x, contact_reach * thickness_, near_);
  for (const model::Proximity& pair : near_)
    findings_.least = std::min(findings_.least.value_or(contact_reach), pair.distance / thickness_);
}

void ContactWatch::see_energy(double t, const solver::State& y) {
  const double kinetic = solver::kinetic_energy(cloth_->ode, y.v), potential = solver::stored_energy(cloth_->ode, t, y);
  energies_->least = std::min(energies_->least, kinetic + potential);
  energies_->scale = std::max(energies_->scale, kinetic + std::abs(potential - energies_->potential));
  const double rise = kinetic + potential - energies_->least;
  if (energies_->scale > 0) findings_.energy_rise = std::max(*findings_.energy_rise, rise / energies_->scale);
}

/// Without those that count as impulses of obstacles.
Eigen::Vector3d ContactWatch::force(double t, const solver::State& y) {
  const solver::SplitOde& ode = cloth_->ode;
  ode.force(t, y.x, y.v, f_);
  const Eigen::Vector3d all = f_.colwise().sum();
  if (!ode.step_forces) return all;
  ode.step_forces->of_obstacles(solver::StepForces::Part::whole, t, y, f_);
  return all - f_.colwise().sum().transpose();
}

}  // namespace drape::bench
