#pragma once

#include "model/sheet/grid.hpp"
#include "model/sheet/material.hpp"

namespace drape::model {

/// Wind from one direction, steady or oscillating [Etzmuß 2002, (2.35)–(2.36)]: (a + sin ωt) w, of which a surface takes the
/// part along its normal times c_drag and the rest times c_lift.
struct Wind {
  Eigen::Vector3d load = Eigen::Vector3d::Zero();  ///< w, a force per area [N/m²]
  double constant = 1;                             ///< a
  double frequency = 0;                            ///< ω [rad/s]
  double drag = 1;                                 ///< c_drag
  double lift = 0;                                 ///< c_lift

  bool blows() const { return !load.isZero(0) && (constant != 0 || frequency != 0) && (drag != 0 || lift != 0); }
  bool needs_normals() const { return blows() && drag != lift; }  ///< or else the surface takes it undivided
};

/// A sheet before it is compiled: what every force is made from.
struct Sheet {
  Grid grid;
  Material material;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  Wind wind = {};
  double air = 0;  ///< c = c_w ρ_air of the air's resistance (2.37) [N s/m³]
};

}  // namespace drape::model
