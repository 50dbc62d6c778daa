#include "model/sheet/grid.hpp"

namespace drape::model {

solver::Vectors Grid::parameters() const {
  solver::Vectors x(particles(), 3);
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) x.row(index(a, b)) << (nu > 1 ? a * spacing_u() : 0.0), (nv > 1 ? b * spacing_v() : 0.0), 0.0;
  return x;
}

Eigen::VectorXd Grid::cell_areas() const {
  Eigen::VectorXd areas(particles());
  for (int i = 0; i < particles(); ++i) areas[i] = cell_area(i % nu, i / nu);
  return areas;
}

}  // namespace drape::model
