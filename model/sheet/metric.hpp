#pragma once

#include <array>

#include "model/sheet/cells.hpp"

namespace drape::model {

/// One entry of a difference stencil.
struct StencilEntry {
  int particle;
  double coefficient;
};

/// The second difference Σ c x/l² along a line: entries of the particle before, the particle itself, the one after, and the two
/// across the line.
struct LineDifference {
  std::array<StencilEntry, 5> entries;
  double length;  ///< l: the mean of the two spacings [m]
};

/// The mixed difference Σ c x/(l_u l_v) of a cell; entry 2a + b is of corner [a][b].
struct CellDifference {
  std::array<StencilEntry, 4> entries;
  double length_u, length_v;  ///< means of the opposite edges [m]
};

/// The particles beside one along u and v; the particle itself where there is none.
struct Neighbours {
  int left, right, lower, upper;
};

/// Lengths, areas and differences of a grid at rest; areas are those of cloth.
///
/// Differences vanish on all affine images of the pattern: what lines have of them there, since they are curved or not
/// parallel, is taken off along the tangents.
class Metric {
 public:
  explicit Metric(const Grid& grid);

  const Grid& grid() const { return grid_; }

  double length(EdgeEnds edge) const;                           ///< [m]
  double area(const Cell& cell) const;                          ///< [m²]
  double area(int particle) const { return areas_[particle]; }  ///< that it stands for [m²]

  /// The mean length of a cell's edges along u, and the height with which that gives the area [m].
  std::pair<double, double> sides(const Cell& cell) const;

  /// <P, Q> of two edges of a cell at rest [m²]; 0 if the grid is uniform.
  double product(EdgeEnds p, EdgeEnds q) const;

  /// |P|²|Q|²/A of two edges of a cell of area A [m²]; the area itself if the grid is uniform.
  double quadrant_measure(const Cell& cell, EdgeEnds p, EdgeEnds q) const;

  /// The area of the strip that the edge from particle (a, b) to the next along u or v stands for: half of the cloth beside it
  /// [m²]; 0 if there is no such edge.
  double strip_area(int a, int b, bool weft) const;

  /// Those that cloth joins to particle (a, b).
  Neighbours neighbours(int a, int b) const;

  /// Whether it is joined on both sides.
  bool bends(int a, int b, bool weft) const;

  /// The area that stands for the curvature along u or v at a particle that bends [m²]: its own, unless there is a cut.
  double bent_area(int a, int b, bool weft) const;

  /// Along u or v at particle (a, b), which is not on the ends of the line.
  LineDifference second_difference(int a, int b, bool weft) const;

  CellDifference mixed_difference(const Cell& cell) const;

 private:
  Eigen::Vector2d place(int i) const { return pattern_.row(i).head<2>(); }
  Eigen::Vector2d place(EdgeEnds edge) const { return place(edge.end) - place(edge.begin); }

  bool joined(int a, int b, bool weft) const { return strip_area(a, b, weft) > 0; }

  Grid grid_;
  Vectors pattern_;  ///< this and quads_: empty if the grid is uniform
  Eigen::VectorXd areas_, quads_;
};

}  // namespace drape::model
