#pragma once

#include <Eigen/Dense>

namespace drape::solver {

/// A half-space that a particle must not leave in the step ahead: at its end <x, n> ≥ `least`.
struct Contact {
  int particle = 0;
  int obstacle = 0;        ///< tells the contacts of a particle apart from step to step
  Eigen::Vector3d normal;  ///< n at the end of the step: unit, away from the obstacle
  double gap = 0;          ///< distance from the collision area at the beginning of the step [m], negative inside
  double least = 0;        ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< w of the obstacle's surface, its mean over the step [m/s]
  double friction = 0;                                 ///< η, Coulomb's coefficient
};

}  // namespace drape::solver
