#pragma once

#include <array>

#include "solver/contact/pair_search.hpp"

namespace drape::solver {

/// A linear function of the velocities of a pair's four particles; its coefficients are the impulses on them for a unit of
/// impulse along it.
struct PairDirection {
  std::array<Eigen::Vector3d, 4> of;

  double along(const std::array<int, 4>& particles, const Vectors& v) const {
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += v.row(particles[k]).dot(of[k]);
    return sum;
  }
};

/// What a pair is without points of bodies. Particles that its motion does not ask stand for them.
struct ClothPart {
  std::array<int, 4> particles;
  std::array<bool, 4> of_body;
  Eigen::Vector3d body;  ///< Σ w x of the bodies' points when the step begins [m]
  Eigen::Vector3d way;   ///< by which this moves in the step [m]

  bool meets_body() const { return of_body[0] || of_body[1] || of_body[2] || of_body[3]; }
};

/// `count`: of the cloth's particles.
ClothPart cloth_part(const PairContact& pair, const PairContact::Points& points, Eigen::Index count, const BodyPoints& bodies);

/// How the points of a pair move against each other: apart, along the normal, and in two directions across it.
using PairMotion = std::array<PairDirection, 3>;

/// Columns: this normal and two directions across it.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& normal);

/// The motion of a pair with these nearest points. Impulses along it have no torque about the particles' centre at x: friction
/// acts between two layers, at the distance of whose middles its forces would turn them. `mass`: of all particles [kg].
PairMotion motion_of(const PairContact::Points& points, const std::array<int, 4>& particles, const Eigen::VectorXd& mass,
                     const Vectors& x);

/// The same with the torque, as where something else holds a point of the pair.
PairMotion held_motion_of(const PairContact::Points& points, const std::array<bool, 4>& of_body = {});

}  // namespace drape::solver
