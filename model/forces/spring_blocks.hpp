#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace drape::model {

/// The pull of a spring of unit modulus and rest length l over d, (|d|/l − 1) d° [(2.20)], differentiated by d. `exact`: else
/// without its negative curvature.
inline Eigen::Matrix3d tension_block(const Eigen::Vector3d& d, double length, bool exact) {
  const double r = d.norm();
  const Eigen::Vector3d n = d / r;
  const Eigen::Matrix3d nn = n * n.transpose();
  const double turn = 1 / length - 1 / r;  // negative where the edge is compressed
  return nn / length + (exact ? turn : std::max(turn, 0.0)) * (Eigen::Matrix3d::Identity() - nn);
}

/// The pull of a dashpot of unit modulus along d, <u, d°>/l d° [(2.28)] for the relative velocity u, differentiated by u ...
inline Eigen::Matrix3d viscous_block(const Eigen::Vector3d& d, double length) {
  const Eigen::Vector3d n = d.normalized();
  return n * n.transpose() / length;
}

/// ... and by d.
inline Eigen::Matrix3d viscous_turn_block(const Eigen::Vector3d& d, const Eigen::Vector3d& u, double length) {
  const double r = d.norm();
  const Eigen::Vector3d n = d / r;
  const Eigen::Matrix3d P = Eigen::Matrix3d::Identity() - n * n.transpose();
  return (n * (P * u).transpose() + u.dot(n) * P) / (length * r);
}

}  // namespace drape::model
