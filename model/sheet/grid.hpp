#pragma once

#include <vector>

#include "solver/state.hpp"

namespace drape::model {

using solver::SparseMatrix;
using solver::Vectors;

/// Mass of particles on a border and stiffness of springs along it: half of those inside, as their dual cells are, or the
/// whole, as in the thesis' algorithms.
enum class BorderCells { dual, whole };

/// The parameter domain of a rectangular sheet: nu × nv particles; u is the weft direction, v the warp direction.
///
/// A direction with a single particle makes a chain [Etzmuß 2002, 2.2]: its spacing is then the width of the strip that
/// the chain stands for.
struct Grid {
  int nu = 2;
  int nv = 2;
  double size_u = 1;  ///< [m]
  double size_v = 1;  ///< [m]
  BorderCells border_cells = BorderCells::dual;

  int particles() const { return nu * nv; }
  int index(int a, int b) const { return a + nu * b; }
  double spacing_u() const { return nu > 1 ? size_u / (nu - 1) : size_u; }  ///< l_u [m]
  double spacing_v() const { return nv > 1 ? size_v / (nv - 1) : size_v; }  ///< l_v [m]

  /// Width of the dual cell at place a of n as a part of the spacing: 1 inside, ½ on a border, 1 if there is only one.
  static double dual_width(int a, int n) { return n > 1 && (a == 0 || a == n - 1) ? 0.5 : 1.0; }

  /// Width of the cell that column a or line b stands for [m].
  double cell_width_u(int a) const { return (border_cells == BorderCells::whole ? 1 : dual_width(a, nu)) * spacing_u(); }
  double cell_width_v(int b) const { return (border_cells == BorderCells::whole ? 1 : dual_width(b, nv)) * spacing_v(); }

  /// Area that particle (a, b) stands for [m²].
  double cell_area(int a, int b) const { return cell_width_u(a) * cell_width_v(b); }

  /// The areas of all particles [m²].
  Eigen::VectorXd cell_areas() const;

  /// Positions (u, v) of all particles as (x, y), z = 0: N × 3 [m].
  solver::Vectors parameters() const;
};

}  // namespace drape::model
