#include "model/sheet/grid.hpp"

#include <algorithm>

namespace drape::model {
namespace {

Outline rectangle(double size_u, double size_v) {
  const Eigen::Vector2d p00(0, 0), p10(size_u, 0), p01(0, size_v), p11(size_u, size_v);
  const auto line = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to) -> std::vector<CurvePiece> {
    return {{CurvePiece::Kind::line, {from, to}}};
  };
  return {.lower = line(p00, p10), .upper = line(p01, p11), .left = line(p00, p01), .right = line(p10, p11)};
}

double cross(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) { return a[0] * b[1] - a[1] * b[0]; }

}  // namespace

Vectors Grid::parameters() const {
  if (!uniform())
    return transfinite(outline.given() ? outline : rectangle(size_u, size_v), graded(nu, grading_u), graded(nv, grading_v));
  Vectors x(particles(), 3);
  for (int b = 0; b < nv; ++b)
    for (int a = 0; a < nu; ++a) x.row(index(a, b)) << (nu > 1 ? a * spacing_u() : 0.0), (nv > 1 ? b * spacing_v() : 0.0), 0.0;
  return x;
}

Eigen::VectorXd Grid::quad_areas() const {
  const int columns = std::max(nu - 1, 0), lines = std::max(nv - 1, 0);
  if (uniform()) return Eigen::VectorXd::Constant(columns * lines, spacing_u() * spacing_v());
  const Vectors x = parameters();
  Eigen::VectorXd areas(columns * lines);
  for (int b = 0; b < lines; ++b)
    for (int a = 0; a < columns; ++a)
      areas[a + columns * b] =
          cross(x.row(index(a + 1, b + 1)) - x.row(index(a, b)), x.row(index(a, b + 1)) - x.row(index(a + 1, b))) / 2;
  return areas;
}

Eigen::VectorXd Grid::cell_areas() const {
  Eigen::VectorXd areas(particles());
  if (uniform()) {
    for (int i = 0; i < particles(); ++i) areas[i] = cell_width_u(i % nu) * cell_width_v(i / nu);
    return areas;
  }
  const Eigen::VectorXd quads = quad_areas();
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
