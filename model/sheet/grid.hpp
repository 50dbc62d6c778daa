#pragma once

#include <vector>

#include "model/sheet/outline.hpp"
#include "solver/state.hpp"

namespace drape::model {

using solver::SparseMatrix;
using solver::Vectors;

/// Mass of particles on a border and stiffness of springs along it: half of those inside, as their dual cells are, or the
/// whole, as in the thesis' algorithms.
enum class BorderCells { dual, whole };

/// The parameter domain of a panel: nu × nv particles; u is the weft direction, v the warp direction. It is a rectangle with
/// equal spacings, unless it has an outline or a grading. A cut leaves the cloth inside a curve.
///
/// A direction with a single particle makes a chain [Etzmuß 2002, 2.2]: its spacing is then the width of the strip that
/// the chain stands for.
struct Grid {
  int nu = 2;
  int nv = 2;
  double size_u = 1;  ///< [m]
  double size_v = 1;  ///< [m]
  BorderCells border_cells = BorderCells::dual;
  Outline outline = {};  ///< in the place of the rectangle, whose sides are then those of the box around it
  double grading_u = 1;  ///< the last spacing over the first
  double grading_v = 1;
  std::vector<CurvePiece> cut = {};  ///< closed, on the pattern; empty: none

  bool is_cut() const { return !cut.empty(); }
  bool uniform() const { return !outline.given() && grading_u == 1 && grading_v == 1 && !is_cut(); }
  int particles() const { return nu * nv; }
  int index(int a, int b) const { return a + nu * b; }
  int quad(int a, int b) const { return a + (nu - 1) * b; }  ///< place of the quadrilateral whose lower left corner is (a, b)

  // A uniform grid only:
  double spacing_u() const { return nu > 1 ? size_u / (nu - 1) : size_u; }  ///< l_u [m]
  double spacing_v() const { return nv > 1 ? size_v / (nv - 1) : size_v; }  ///< l_v [m]

  /// Width of the dual cell at place a of n as a part of the spacing: 1 inside, ½ on a border, 1 if there is only one.
  static double dual_width(int a, int n) { return n > 1 && (a == 0 || a == n - 1) ? 0.5 : 1.0; }

  /// Width of the cell that column a or line b stands for [m].
  double cell_width_u(int a) const { return (border_cells == BorderCells::whole ? 1 : dual_width(a, nu)) * spacing_u(); }
  double cell_width_v(int b) const { return (border_cells == BorderCells::whole ? 1 : dual_width(b, nv)) * spacing_v(); }

  // Any grid:

  /// The areas that particles stand for; 0 of those that a cut leaves outside [m²].
  Eigen::VectorXd cell_areas() const;

  /// The particles that a cut leaves outside.
  std::vector<int> outside() const;

  /// The areas of cloth between the lines, line by line, where the particles are at `pattern` [m²].
  Eigen::VectorXd quad_areas(const Vectors& pattern) const;

  /// Positions (u, v) of all particles in the pattern as (x, y), z = 0: N × 3 [m].
  Vectors parameters() const;
};

}  // namespace drape::model
