#include "model/sheet/edges.hpp"

#include <algorithm>
#include <limits>

#include "model/sheet/metric.hpp"

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

std::vector<Edge> edges(const Grid& grid) {
  if (grid.uniform()) return uniform_edges(grid);
  const Metric metric(grid);
  std::vector<Edge> all;
  for (const bool weft : {true, false})
    for (int b = 0; b < grid.nv; ++b)
      for (int a = 0; a < grid.nu; ++a) {
        const double area = metric.strip_area(a, b, weft);
        if (area == 0) continue;
        const EdgeEnds ends{grid.index(a, b), weft ? grid.index(a + 1, b) : grid.index(a, b + 1)};
        const double length = metric.length(ends);
        all.push_back({ends.begin, ends.end, weft, length, area / length});
      }
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
