#pragma once

#include <utility>
#include <vector>

#include "model/term.hpp"

namespace drape::model {

/// An edge of the grid from particle i to particle j, in the u or the v direction.
struct Edge {
  int i, j;
  bool weft;      ///< along u
  double length;  ///< rest length l [m]
  double width;   ///< width of the strip the edge stands for [m]: the other spacing, half of it on a border
};

/// All edges: weft first, then warp.
std::vector<Edge> edges(const Grid& grid);

/// The value of a modulus along an edge.
inline double along(const WeftWarp& modulus, const Edge& edge) { return edge.weft ? modulus.weft : modulus.warp; }

/// Evaluates a force along edges line by line, so that a line's kernel is one loop without branches or conflicts.
class EdgeSweep {
 public:
  explicit EdgeSweep(const Grid& grid);

  /// Edges between neighbours in one line: edge e runs from particle i + e to particle j + e, widths[e] as in Edge.
  struct Line {
    int i, j, count;
    bool weft;
    const double* widths;
  };

  /// Calls kernel(line, g) for every line, which writes the pull of edge e to g[3e … 3e+2]; adds g to i and −g to j.
  template <class Kernel>
  void operator()(Vectors& f, const Kernel& kernel) {
    for (const Line& line : lines_) {
      kernel(line, pull_.data());
      const auto g = Eigen::Map<const Eigen::ArrayXd>(pull_.data(), 3 * line.count);
      Eigen::Map<Eigen::ArrayXd>(f.data() + 3 * line.i, 3 * line.count) += g;
      Eigen::Map<Eigen::ArrayXd>(f.data() + 3 * line.j, 3 * line.count) -= g;
    }
  }

 private:
  std::vector<double> widths_, pull_;
  std::vector<Line> lines_;
};

/// Adds a matrix of springs: weight at (i, j) and (j, i), −weight on their diagonals.
void add_spring(std::vector<Eigen::Triplet<double>>& entries, int i, int j, double weight);

/// The ends of an edge vector x_end − x_begin.
struct EdgeEnds {
  int begin, end;
};

/// For an energy gradient g = ∂E/∂p of the edge vector p that depends on the edge vector r: adds the blocks of the forces
/// −g on the end and +g on the begin of p, derived by the ends of r. block = ∂g/∂r.
template <class Add>
void add_edge_pair(const Add& add, EdgeEnds p, EdgeEnds r, const Eigen::Matrix3d& block) {
  add(p.end, r.end, -block);
  add(p.end, r.begin, block);
  add(p.begin, r.end, block);
  add(p.begin, r.begin, -block);
}

}  // namespace drape::model
