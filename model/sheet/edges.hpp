#pragma once

#include <functional>
#include <vector>

#include "model/sheet/grid.hpp"
#include "model/sheet/sheet.hpp"

namespace drape::model {

/// An edge of the grid from particle i to particle j, in the u or the v direction.
struct Edge {
  int i, j;
  bool weft;      ///< along u
  double length;  ///< rest length l [m]
  double width;   ///< width of the strip the edge stands for [m]: of a uniform grid the other spacing, half of it on a border
};

/// All edges that have cloth: weft first, then warp.
std::vector<Edge> edges(const Grid& grid);

/// The shortest rest lengths along weft and warp [m]; of a chain across it the width it stands for.
WeftWarp shortest_edges(const Grid& grid);

/// The value of a modulus along an edge.
inline double along(const WeftWarp& modulus, const Edge& edge) { return edge.weft ? modulus.weft : modulus.warp; }

/// The ends of an edge vector x_end − x_begin.
struct EdgeEnds {
  int begin, end;
};

/// Adds the entries of a spring between two particles: the weight beside the diagonal, minus it there.
void add_spring(std::vector<Eigen::Triplet<double>>& entries, EdgeEnds edge, double weight);

/// The N × N matrix of springs on all edges of weight ≠ 0.
SparseMatrix spring_matrix(const Grid& grid, const std::function<double(const Edge&)>& weight);

/// Adds the pull of an edge on its ends.
inline void add_pull(Vectors& f, EdgeEnds edge, const Eigen::Vector3d& pull) {
  f.row(edge.begin) += pull;
  f.row(edge.end) -= pull;
}

/// For an energy gradient g = ∂E/∂p of the edge vector p that depends on the edge vector r: adds the blocks of the forces
/// −g on the end and +g on the beginning of p, differentiated by the ends of r. block = ∂g/∂r.
template <class Add>
void add_edge_pair(const Add& add, EdgeEnds p, EdgeEnds r, const Eigen::Matrix3d& block) {
  add(p.end, r.end, -block);
  add(p.end, r.begin, block);
  add(p.begin, r.end, block);
  add(p.begin, r.begin, -block);
}

}  // namespace drape::model
