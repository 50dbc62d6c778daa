#pragma once

#include <array>
#include <memory>
#include <vector>

#include "model/forces/fused/kernels.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// The edges, cells and particles of a grid that is not uniform; widths and areas are 0 where there is none. The rows of a line
/// are one after the other, such that the same columns of all lie in different sets of a cache.
class GridShape {
 public:
  /// Loops run over `length` columns.
  GridShape(const Grid& grid, int length);

  Rows line(int b) const { return {&rows_(0, shape_rows * b), rows_.rows()}; }

 private:
  Eigen::ArrayXXd rows_;  ///< one column for each row of each line
};

/// Evaluates a law in one pass over memory, line by line: reads x and v once and writes f once.
///
/// A line's coordinates are split into three arrays that stay in a near cache. Edges and their pulls are loops over these
/// without branches, and a particle gets the difference of its edges' pulls: f = div σ. Borders are not a special case: edges
/// and cells that do not exist have the width 0.
class FusedForces {
 public:
  FusedForces(const Grid& grid, const GridLaw& law);

  /// Sets f to the law's forces [N]; x, v, f: N × 3. Velocities are not read unless the law asks for them. Threads take a band
  /// of lines each; they compute the edges and cells between their bands twice, so that none waits for another.
  void operator()(const solver::Vectors& x, const solver::Vectors& v, solver::Vectors& f);

 private:
  /// Particles of a line and the weft edges between them; the warp edges that lead to them from the line before, and the
  /// pulls that the cells between the lines add to the warp edge on their right.
  struct Line {
    Field x, v;
    Edges weft, warp;
    Field pull_right;
  };

  /// The line with even b and the one with odd b, of one thread.
  struct TwoLines {
    explicit TwoLines(int length);

    Eigen::ArrayXd memory;
    std::array<Line, 2> line;
  };

  /// Sets the forces on the lines [begin, end).
  void evaluate(int begin, int end, const std::array<Line, 2>& lines, const solver::Vectors& x, const solver::Vectors& v,
                solver::Vectors& f) const;

  Edges weft_of(int b, const Line& line) const;
  Edges warp_of(int b, const Line& line) const;
  void read(int b, Columns columns, const solver::Vectors& from, const Field& to) const;
  void pull_weft(int b, Columns columns, const Line& line) const;
  void pull_warp(int b, Columns columns, const Line& before, const Line& line) const;
  void pull_cells(int b, Columns columns, const Line& before, const Line& line) const;
  void write(int b, Columns columns, const Line& line, const Line& next, solver::Vectors& f) const;
  void clear_warp(const Line& line) const;

  Grid grid_;
  GridLaw law_;
  EdgePull weft_, warp_;                    ///< for a strip of unit width
  int length_;                              ///< number of columns that the loops run over
  bool fetches_;                            ///< whether x, v and f come from memory
  Eigen::ArrayXd weft_width_;               ///< 1 where the edge and the cell towards the next column exist, else 0
  Eigen::ArrayXd warp_width_;               ///< width of the edges along v [m], 0 where there is no column
  std::unique_ptr<const GridShape> shape_;  ///< null if the grid is uniform
  std::vector<TwoLines> lines_;             ///< of each thread so far
};

}  // namespace drape::model
