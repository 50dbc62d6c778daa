#pragma once

#include <vector>

#include "solver/state.hpp"

namespace drape::model {

/// The parameter domain of a rectangular sheet: nu × nv particles; u is the weft direction, v the warp direction.
///
/// A direction with a single particle makes a chain [Etzmuß 2002, 2.2]: its spacing is then the width of the strip that
/// the chain stands for.
struct Grid {
  int nu = 2;
  int nv = 2;
  double size_u = 1;  ///< [m]
  double size_v = 1;  ///< [m]

  int particles() const { return nu * nv; }
  int index(int a, int b) const { return a + nu * b; }
  double spacing_u() const { return nu > 1 ? size_u / (nu - 1) : size_u; }  ///< l_u [m]
  double spacing_v() const { return nv > 1 ? size_v / (nv - 1) : size_v; }  ///< l_v [m]

  /// Width of the dual cell at place a of n as a part of the spacing: 1 inside, ½ on a border, 1 if there is but one.
  static double dual_width(int a, int n) { return n > 1 && (a == 0 || a == n - 1) ? 0.5 : 1.0; }

  /// Area of the dual cell of particle (a, b) [m²].
  double dual_area(int a, int b) const { return dual_width(a, nu) * dual_width(b, nv) * spacing_u() * spacing_v(); }

  /// Positions (u, v) of all particles as (x, y), z = 0: N × 3 [m].
  solver::Vectors parameters() const;
};

}  // namespace drape::model
