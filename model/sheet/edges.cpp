#include "model/sheet/edges.hpp"

#include <algorithm>
#include <limits>

namespace drape::model {

namespace {

std::vector<Edge> uniform_edges(const Grid& grid) {
  const double lu = grid.spacing_u(), lv = grid.spacing_v();
  std::vector<Edge> all;
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a + 1 < grid.nu; ++a)
      all.push_back({grid.index(a, b), grid.index(a + 1, b), true, lu, grid.cell_width_v(b)});
  for (int b = 0; b + 1 < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) all.push_back({grid.index(a, b), grid.index(a, b + 1), false, lv, grid.cell_width_u(a)});
  return all;
}

}  // namespace

/// Elsewhere an edge's strip has half the area of the quadrilaterals beside it.
std::vector<Edge> edges(const Grid& grid) {
  if (grid.uniform()) return uniform_edges(grid);
  const Vectors x = grid.parameters();
  const Eigen::VectorXd quads = grid.quad_areas(x);
  const int columns = grid.nu - 1, lines = grid.nv - 1;
  std::vector<Edge> all;
  const auto add = [&](int i, int j, bool weft, int a, int b) {
    const int before_a = weft ? a : a - 1, before_b = weft ? b - 1 : b;
    double sum = 0;
    int count = 0;
    if (before_a >= 0 && before_b >= 0) sum += quads[before_a + columns * before_b], ++count;
    if (a < columns && b < lines) sum += quads[a + columns * b], ++count;
    if (sum == 0) return;
    const double length = (x.row(j) - x.row(i)).norm();
    all.push_back({i, j, weft, length, sum / (grid.border_cells == BorderCells::whole ? count : 2) / length});
  };
  for (int b = 0; b <= lines; ++b)
    for (int a = 0; a < columns; ++a) add(grid.index(a, b), grid.index(a + 1, b), true, a, b);
  for (int b = 0; b < lines; ++b)
    for (int a = 0; a <= columns; ++a) add(grid.index(a, b), grid.index(a, b + 1), false, a, b);
  return all;
}

WeftWarp shortest_edges(const Grid& grid) {
  if (grid.uniform()) return {grid.spacing_u(), grid.spacing_v()};
  WeftWarp shortest{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const Edge& edge : edges(grid)) {
    double& length = edge.weft ? shortest.weft : shortest.warp;
    length = std::min(length, edge.length);
  }
  return shortest;
}

void add_spring(std::vector<Eigen::Triplet<double>>& entries, EdgeEnds edge, double weight) {
  entries.emplace_back(edge.begin, edge.begin, -weight);
  entries.emplace_back(edge.end, edge.end, -weight);
  entries.emplace_back(edge.begin, edge.end, weight);
  entries.emplace_back(edge.end, edge.begin, weight);
}

SparseMatrix spring_matrix(const Grid& grid, const std::function<double(const Edge&)>& weight) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Edge& edge : edges(grid)) {
    if (const double w = weight(edge); w != 0) add_spring(entries, {edge.i, edge.j}, w);
  }
  SparseMatrix matrix(grid.particles(), grid.particles());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace drape::model
