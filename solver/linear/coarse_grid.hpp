#pragma once

#include <algorithm>

#include "solver/linear/five_point.hpp"

namespace drape::solver {

/// How one direction of a grid is coarsened: not at all, or to every other place and the last.
struct Coarsening {
  int fine = 1;
  bool halved = false;

  int coarse() const { return halved ? fine / 2 + 1 : fine; }

  /// The coarse place at or before a.
  int parent(int a) const { return halved ? (a + (a == fine - 1)) / 2 : a; }

  /// Whether a lies halfway between parent(a) and the next.
  bool between(int a) const { return halved && a % 2 == 1 && a < fine - 1; }

  /// The place of a coarse place on the fine grid.
  int place(int coarse) const { return halved ? std::min(2 * coarse, fine - 1) : coarse; }

  /// Whether both a and a + 1 are coarse places.
  bool kept(int a) const { return !halved || (a % 2 == 0 && a == fine - 2); }

  /// Calls f(place, weight) for the coarse places from which a is interpolated.
  template <class F>
  void parents(int a, const F& f) const {
    if (!between(a)) return f(parent(a), 1.0);
    f(parent(a), 0.5);
    f(parent(a) + 1, 0.5);
  }
};

/// The next coarser grid, its matrix, and how it was coarsened. Particles without neighbours (pinned ones) are interpolated by
/// 0.
struct CoarseGrid {
  Coarsening u, v;
  FivePoint A;

  /// Halves the direction of the stronger coupling, or both if neither is four times the other.
  explicit CoarseGrid(const FivePoint& fine);
};

}  // namespace drape::solver
