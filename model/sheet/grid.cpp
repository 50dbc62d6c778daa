#include "model/sheet/grid.hpp"

#include <iterator>
#include <vector>

#include "model/sheet/cells.hpp"

namespace drape::model {
Vectors Grid::parameters() const {
  if (!uniform())
    return transfinite(outline.given() ? outline : parallelogram({size_u, 0}, {0, size_v}), graded(nu, grading_u),
                       graded(nv, grading_v));
  Vectors x(particles(), 3);
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) x.row(index(a, b)) << (nu > 1 ? a * spacing_u() : 0.0), (nv > 1 ? b * spacing_v() : 0.0), 0.0;
  return x;
}

Eigen::VectorXd Grid::quad_areas(const Vectors& pattern) const {
  const std::vector<Cell> all = cells(*this);
  Eigen::VectorXd areas(std::ssize(all));
  for (std::size_t k = 0; k < all.size(); ++k) areas[static_cast<Eigen::Index>(k)] = quad_area(pattern, all[k]);
  return areas;
}

Eigen::VectorXd Grid::cell_areas() const {
  Eigen::VectorXd areas(particles());
  if (uniform()) {
    for (int i = 0; i < particles(); ++i) areas[i] = cell_width_u(i % nu) * cell_width_v(i / nu);
    return areas;
  }
  const Eigen::VectorXd quads = quad_areas(parameters());
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) {
      double sum = 0;
      int count = 0;
      for (const int line : {b - 1, b})
        for (const int column : {a - 1, a})
          if (column >= 0 && column < nu - 1 && line >= 0 && line < nv - 1) sum += quads[column + (nu - 1) * line], ++count;
      areas[index(a, b)] = sum / (border_cells == BorderCells::whole ? count : 4);
    }
  return areas;
}

}  // namespace drape::model
