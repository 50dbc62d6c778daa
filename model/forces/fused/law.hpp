#pragma once

#include <Eigen/Core>

namespace drape::model {

/// The pull of an edge p = x_j − x_i on its ends, for a strip of unit width [N/m]:
///   (spring − thread/|p| + dashpot <p, ṗ>/<p, p>) p + drag ṗ.
struct EdgeLaw {
  double spring = 0;   ///< [N/m²]
  double thread = 0;   ///< [N/m]
  double dashpot = 0;  ///< [N s/m²]
  double drag = 0;     ///< [N s/m²]

  bool needs_velocities() const { return dashpot != 0 || drag != 0; }

  EdgeLaw& operator+=(const EdgeLaw& other) {
    spring += other.spring, thread += other.thread, dashpot += other.dashpot, drag += other.drag;
    return *this;
  }
  EdgeLaw operator*(double width) const { return {width * spring, width * thread, width * dashpot, width * drag}; }
  bool operator==(const EdgeLaw&) const = default;
};

/// What the edges of a cell pull with since there are others. An edge p along u and an edge q along v of the cell pull
///   along q and along p:      shear <p, q> + shear_rate d/dt <p, q>   (each quadrant),
///   along p° l_v and q° l_u:  contraction ε + contraction_rate ε̇,    ε the other pair's summed strains.
struct CellLaw {
  double shear = 0;             ///< [N/m³]
  double shear_rate = 0;        ///< [N s/m³]
  double contraction = 0;       ///< [N/m]
  double contraction_rate = 0;  ///< [N s/m]

  bool acts() const { return *this != CellLaw{}; }
  bool contracts() const { return contraction != 0 || contraction_rate != 0; }
  bool needs_velocities() const { return shear_rate != 0 || contraction_rate != 0; }

  CellLaw& operator+=(const CellLaw& other) {
    shear += other.shear, shear_rate += other.shear_rate;
    contraction += other.contraction, contraction_rate += other.contraction_rate;
    return *this;
  }
  bool operator==(const CellLaw&) const = default;
};

/// Forces of a sheet that depend on nothing but the edges of single cells: the laws of several terms add up to one, which
/// GridSweep evaluates.
struct GridLaw {
  EdgeLaw weft = {}, warp = {};
  CellLaw cell = {};
  Eigen::Vector3d load = Eigen::Vector3d::Zero();  ///< force on a unit of area [N/m²]

  bool acts() const { return *this != GridLaw{}; }
  bool needs_velocities() const { return weft.needs_velocities() || warp.needs_velocities() || cell.needs_velocities(); }

  GridLaw& operator+=(const GridLaw& other) {
    weft += other.weft, warp += other.warp, cell += other.cell, load += other.load;
    return *this;
  }
  bool operator==(const GridLaw&) const = default;
};

}  // namespace drape::model
