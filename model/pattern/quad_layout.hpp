#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/pattern/sewing_pattern.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// The edges of a panel with which its lower, right, upper and left side begin, counterclockwise.
using FourSides = std::array<std::size_t, 4>;

/// The edges of one of its sides, counterclockwise. `edges`: of the panel.
std::vector<std::size_t> edges_of_side(const FourSides& sides, std::size_t side, std::size_t edges);

/// How panels are filled with the cells of grids.
struct QuadLayout {
  std::vector<FourSides> sides;         ///< of every panel
  std::vector<std::vector<int>> cells;  ///< of every edge of every panel
};

/// The sides of every panel are between corners that are nearly right angles, so that opposite sides are nearly as long and the
/// lines of its grid do not cross. Darts, which are edges side by side that are sewn, have no corners. The lower side goes
/// along u as far as one does. Edges that are sewn have the same number of cells, opposite sides too in sum, and as near as
/// that allows to the length over the spacing [m] (a mixed-integer programme, solved by GLPK). Throws SceneError, naming the
/// panel, if there is no such layout.
QuadLayout quad_layout(const SewingPattern& pattern, double spacing);

/// The sides of a grid. `cells`: of every edge; empty: pieces do not count them.
Outline outline_of(const PatternPanel& panel, const FourSides& sides, const std::vector<int>& cells);

/// The grid of a panel.
Grid grid_of(const PatternPanel& panel, const FourSides& sides, const std::vector<int>& cells);

}  // namespace drape::model
