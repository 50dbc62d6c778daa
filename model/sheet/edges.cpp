#include "model/sheet/edges.hpp"

namespace drape::model {

std::vector<Edge> edges(const Grid& grid) {
  const double lu = grid.spacing_u(), lv = grid.spacing_v();
  std::vector<Edge> all;
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a + 1 < grid.nu; ++a)
      all.push_back({grid.index(a, b), grid.index(a + 1, b), true, lu, grid.cell_width_v(b)});
  for (int b = 0; b + 1 < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) all.push_back({grid.index(a, b), grid.index(a, b + 1), false, lv, grid.cell_width_u(a)});
  return all;
}

void add_spring(std::vector<Eigen::Triplet<double>>& entries, int i, int j, double weight) {
  entries.emplace_back(i, i, -weight);
  entries.emplace_back(j, j, -weight);
  entries.emplace_back(i, j, weight);
  entries.emplace_back(j, i, weight);
}

}  // namespace drape::model
