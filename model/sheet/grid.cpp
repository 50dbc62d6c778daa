#include "model/sheet/grid.hpp"

#include <vector>

#include "model/sheet/cells.hpp"
#include "model/sheet/cut.hpp"

namespace drape::model {
namespace {

using Eigen::Vector2d;

constexpr double negligible = 1e-6;  ///< part of a quadrilateral

/// The part of a quadrilateral that a cut leaves. `nearby`: all of the cut that lies in it, or more.
double part_inside(const std::vector<Vector2d>& nearby, const Vectors& pattern, const Cell& cell) {
  const auto place = [&](int i) -> Vector2d { return pattern.row(i).head<2>(); };
  const auto& k = cell.corner;
  const int around[] = {k[0][0], k[1][0], k[1][1], k[0][1]};
  std::vector<Vector2d> inside = nearby;
  for (int side = 0; side < 4 && !inside.empty(); ++side)
    inside = left_part(inside, place(around[side]), place(around[(side + 1) % 4]));
  const double part = inside.empty() ? 0 : polygon_area(inside) / quad_area(pattern, cell);
  return part < negligible ? 0 : part > 1 - negligible ? 1 : part;
}

}  // namespace

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
  Eigen::VectorXd areas(static_cast<Eigen::Index>(nu - 1) * (nv - 1));
  const std::vector<Vector2d> polygon = closed_polygon(cut);
  for (int b = 0; b + 1 < nv; ++b) {
    std::vector<Vector2d> nearby = polygon;
    if (is_cut()) {
      const auto heights = pattern.col(1).segment(index(0, b), 2 * static_cast<Eigen::Index>(nu));
      const Vector2d lower(0, heights.minCoeff()), upper(0, heights.maxCoeff());
      nearby = left_part(left_part(polygon, lower, lower + Vector2d::UnitX()), upper, upper - Vector2d::UnitX());
    }
    for (int a = 0; a + 1 < nu; ++a) {
      const Cell cell = cell_at(*this, a, b);
      areas[quad(a, b)] = quad_area(pattern, cell) * (is_cut() ? part_inside(nearby, pattern, cell) : 1);
    }
  }
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
          if (column >= 0 && column < nu - 1 && line >= 0 && line < nv - 1) sum += quads[quad(column, line)], ++count;
      areas[index(a, b)] = sum / (border_cells == BorderCells::whole ? count : 4);
    }
  return areas;
}

std::vector<int> Grid::outside() const {
  std::vector<int> found;
  if (!is_cut()) return found;
  const Eigen::VectorXd areas = cell_areas();
  for (int i = 0; i < particles(); ++i)
    if (areas[i] == 0) found.push_back(i);
  return found;
}

}  // namespace drape::model
