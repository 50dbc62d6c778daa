#pragma once

#include <array>
#include <utility>

#include "model/sheet/edges.hpp"

namespace drape::model {

/// A cell of the grid: its corners and its four edges, lower and upper along u, left and right along v.
struct Cell {
  int corner[2][2];  ///< [a][b]: steps in u, steps in v

  EdgeEnds lower() const { return {corner[0][0], corner[1][0]}; }
  EdgeEnds upper() const { return {corner[0][1], corner[1][1]}; }
  EdgeEnds left() const { return {corner[0][0], corner[0][1]}; }
  EdgeEnds right() const { return {corner[1][0], corner[1][1]}; }
};

/// The corners of a cell as pairs of one edge p along u and one edge q along v: the quadrants of its particles.
inline std::array<std::pair<EdgeEnds, EdgeEnds>, 4> quadrants(const Cell& cell) {
  return {
      {{cell.lower(), cell.left()}, {cell.lower(), cell.right()}, {cell.upper(), cell.left()}, {cell.upper(), cell.right()}}};
}

/// The cell whose lower left corner is (a, b).
inline Cell cell_at(const Grid& grid, int a, int b) {
  return {{{grid.index(a, b), grid.index(a, b + 1)}, {grid.index(a + 1, b), grid.index(a + 1, b + 1)}}};
}

/// All cells that have cloth, line by line.
inline std::vector<Cell> cells(const Grid& grid) {
  const Eigen::VectorXd areas = grid.is_cut() ? grid.quad_areas(grid.parameters()) : Eigen::VectorXd();
  std::vector<Cell> all;
  for (int b = 0; b + 1 < grid.nv; ++b)
    for (int a = 0; a + 1 < grid.nu; ++a)
      if (!grid.is_cut() || areas[grid.quad(a, b)] > 0) all.push_back(cell_at(grid, a, b));
  return all;
}

/// The area of a cell whose particles lie in the plane, counterclockwise [m²].
inline double quad_area(const Vectors& pattern, const Cell& cell) {
  const auto diagonal = [&](int from, int to) -> Eigen::RowVector3d { return pattern.row(to) - pattern.row(from); };
  const Eigen::RowVector3d rising = diagonal(cell.corner[0][0], cell.corner[1][1]);
  const Eigen::RowVector3d falling = diagonal(cell.corner[1][0], cell.corner[0][1]);
  return (rising[0] * falling[1] - rising[1] * falling[0]) / 2;
}

inline Eigen::Vector3d difference(const Vectors& x, EdgeEnds edge) { return x.row(edge.end) - x.row(edge.begin); }

}  // namespace drape::model
