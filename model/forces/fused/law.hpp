#pragma once

#include "model/sheet/sheet.hpp"

namespace drape::model {

/// The pull of an edge p = x_j − x_i of rest length l on its ends, for a strip of unit width [N/m], with ε̇ = <p°, ṗ>/l:
///   (spring |p|/l − preload + dashpot ε̇) p° + drag ṗ/l.
struct EdgeLaw {
  WeftWarp spring = {};   ///< [N/m], the edge's part of K
  WeftWarp preload = {};  ///< [N/m]
  WeftWarp dashpot = {};  ///< [N s/m]
  WeftWarp drag = {};     ///< [N s/m], the edge's part of D

  bool needs_velocities() const { return dashpot.any() || drag.any(); }

  EdgeLaw& operator+=(const EdgeLaw& other) {
    spring += other.spring, preload += other.preload, dashpot += other.dashpot, drag += other.drag;
    return *this;
  }
  bool operator==(const EdgeLaw&) const = default;
};

/// The pulls of a cell's edges that depend on its other edges. In a cell of area A an edge p along u and an edge q along v, of
/// lengths l_p and l_q, pull along each other, once for each quadrant, by
///   A/(l_p l_q)² (shear e + shear_rate ė),   e = <p, q> less than at rest;
/// and along themselves, each over its length, by
///   A (contraction ε + contraction_rate ε̇),   ε the other pair's summed strains.
struct CellLaw {
  double shear = 0;             ///< [N/m]
  double shear_rate = 0;        ///< [N s/m]
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

/// Forces of a sheet that depend only on the edges of single cells: the laws of several terms add up to one, which
/// FusedForces evaluates.
struct GridLaw {
  EdgeLaw edge = {};
  CellLaw cell = {};
  Eigen::Vector3d load = Eigen::Vector3d::Zero();  ///< force per area [N/m²]

  bool acts() const { return *this != GridLaw{}; }
  bool needs_velocities() const { return edge.needs_velocities() || cell.needs_velocities(); }

  /// The law without K x + D v.
  GridLaw explicit_part() const {
    GridLaw part = *this;
    part.edge.spring = part.edge.drag = {};
    return part;
  }

  GridLaw& operator+=(const GridLaw& other) {
    edge += other.edge, cell += other.cell, load += other.load;
    return *this;
  }
  bool operator==(const GridLaw&) const = default;
};

}  // namespace drape::model
