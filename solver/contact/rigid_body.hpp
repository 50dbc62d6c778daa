#pragma once

#include "solver/state.hpp"

namespace drape::solver {

/// Mass [kg], centre [m] and moments of inertia about it [kg m²] of some particles.
struct RigidBody {
  double mass = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
};

/// Sums up particles at x, whose masses mass(i) gives.
template <class Particles, class Mass>
RigidBody rigid_body(const Particles& particles, const Mass& mass, const Vectors& x) {
  RigidBody body;
  for (const int i : particles) {
    body.mass += mass(i);
    body.centre += mass(i) * x.row(i).transpose();
  }
  body.centre /= body.mass;
  for (const int i : particles) {
    const Eigen::Vector3d arm = x.row(i).transpose() - body.centre;
    body.inertia += mass(i) * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  return body;
}

}  // namespace drape::solver
