#include "solver/contact/pair_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "solver/contact/rigid_body.hpp"

namespace drape::solver {

ClothPart cloth_part(const PairContact& pair, const PairContact::Points& points, Eigen::Index count, const BodyPoints& bodies) {
  ClothPart part{pair.particles, {}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const int own = *std::ranges::min_element(pair.particles);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Index point = pair.particles[k] - count;
    if (point < 0) continue;
    part.of_body[k] = true;
    part.particles[k] = own;
    part.body += points.weights[k] * bodies.begin.row(point).transpose();
    part.way += points.weights[k] * (bodies.end.row(point) - bodies.begin.row(point)).transpose();
  }
  return part;
}

Eigen::Matrix3d axes_of(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes << normal, normal.unitOrthogonal(), normal.cross(normal.unitOrthogonal());
  return axes;
}

PairMotion held_motion_of(const PairContact::Points& points, const std::array<bool, 4>& of_body) {
  const Eigen::Matrix3d axes = axes_of(points.normal);
  PairMotion motion;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 4; ++k)
      motion[c].of[k] = of_body[k] ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : points.weights[k] * axes.col(c);
  return motion;
}

PairMotion motion_of(const PairContact::Points& points, const std::array<int, 4>& particles, const Eigen::VectorXd& mass,
                     const Vectors& x) {
  PairMotion motion = held_motion_of(points);
  const RigidBody body = rigid_body(
      particles, [&](int i) { return mass[i]; }, x);
  const Eigen::LDLT<Eigen::Matrix3d> inertia(body.inertia);  // takes 0 about the line of particles that are on one
  const auto arm = [&](int k) -> Eigen::Vector3d { return x.row(particles[k]).transpose() - body.centre; };
  for (PairDirection& direction : motion) {
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();  // about the centre; the sum of impulses is 0
    for (int k = 0; k < 4; ++k) torque += arm(k).cross(direction.of[k]);
    const Eigen::Vector3d turn = inertia.solve(torque);
    for (int k = 0; k < 4; ++k) direction.of[k] -= mass[particles[k]] * turn.cross(arm(k));
  }
  return motion;
}

}  // namespace drape::solver
