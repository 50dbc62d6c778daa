#include "model/sheet/metric.hpp"

#include <Eigen/LU>

namespace drape::model {
namespace {

/// The coefficients of `sum` in terms of two tangents.
Eigen::Vector2d components(const Eigen::Vector2d& sum, const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  Eigen::Matrix2d tangents;
  tangents << u, v;
  return tangents.inverse() * sum;
}

}  // namespace

Metric::Metric(const Grid& grid) : grid_(grid), areas_(grid.cell_areas()) {
  if (grid.uniform()) return;
  pattern_ = grid.parameters();
  quads_ = grid.quad_areas(pattern_);
}

double Metric::length(EdgeEnds edge) const {
  if (!grid_.uniform()) return place(edge).norm();
  const bool weft = grid_.nu > 1 && edge.end - edge.begin == 1;
  return weft ? grid_.spacing_u() : grid_.spacing_v();
}

double Metric::area(const Cell& cell) const {
  if (grid_.uniform()) return grid_.spacing_u() * grid_.spacing_v();
  const int i = cell.corner[0][0];
  return quads_[grid_.quad(i % grid_.nu, i / grid_.nu)];
}

std::pair<double, double> Metric::sides(const Cell& cell) const {
  if (grid_.uniform()) return {grid_.spacing_u(), grid_.spacing_v()};
  const double u = (length(cell.lower()) + length(cell.upper())) / 2;
  return {u, area(cell) / u};
}

double Metric::product(EdgeEnds p, EdgeEnds q) const { return grid_.uniform() ? 0 : place(p).dot(place(q)); }

double Metric::quadrant_measure(const Cell& cell, EdgeEnds p, EdgeEnds q) const {
  const double lengths = length(p) * length(q);
  return grid_.uniform() ? lengths : lengths * lengths / area(cell);
}

double Metric::strip_area(int a, int b, bool weft) const {
  if (a < 0 || b < 0 || a + weft >= grid_.nu || b + !weft >= grid_.nv) return 0;
  if (grid_.uniform()) return weft ? grid_.spacing_u() * grid_.cell_width_v(b) : grid_.spacing_v() * grid_.cell_width_u(a);
  const int before_a = weft ? a : a - 1, before_b = weft ? b - 1 : b;
  double sum = 0;
  int count = 0;
  if (before_a >= 0 && before_b >= 0) sum += quads_[grid_.quad(before_a, before_b)], ++count;
  if (a + 1 < grid_.nu && b + 1 < grid_.nv) sum += quads_[grid_.quad(a, b)], ++count;
  return sum / (grid_.border_cells == BorderCells::whole ? count : 2);
}

Neighbours Metric::neighbours(int a, int b) const {
  const int i = grid_.index(a, b);
  return {joined(a - 1, b, true) ? i - 1 : i, joined(a, b, true) ? i + 1 : i, joined(a, b - 1, false) ? i - grid_.nu : i,
          joined(a, b, false) ? i + grid_.nu : i};
}

bool Metric::bends(int a, int b, bool weft) const {
  return joined(a, b, weft) && joined(weft ? a - 1 : a, weft ? b : b - 1, weft);
}

/// The harmonic mean of the strips on both sides: a border particle with little mass gets no more stiffness than its strip has
/// mass.
double Metric::bent_area(int a, int b, bool weft) const {
  if (!grid_.is_cut()) return area(grid_.index(a, b));
  const double after = strip_area(a, b, weft), before = strip_area(weft ? a - 1 : a, weft ? b : b - 1, weft);
  return 2 * before * after / (before + after);
}

LineDifference Metric::second_difference(int a, int b, bool weft) const {
  const int i = grid_.index(a, b);
  const auto [left, right, lower, upper] = neighbours(a, b);
  const int before = weft ? left : lower, after = weft ? right : upper;
  const int across_before = weft ? lower : left, across_after = weft ? upper : right;
  LineDifference found{{{{before, 1}, {i, -2}, {after, 1}, {across_before, 0}, {across_after, 0}}},
                       weft ? grid_.spacing_u() : grid_.spacing_v()};
  if (grid_.uniform()) return found;

  const double first = length({before, i}), second = length({i, after});
  found.length = (first + second) / 2;
  auto& c = found.entries;
  c[0].coefficient = found.length / first;
  c[2].coefficient = found.length / second;
  c[1].coefficient = -c[0].coefficient - c[2].coefficient;
  const Eigen::Vector2d sum = c[0].coefficient * place({i, before}) + c[2].coefficient * place({i, after});
  const Eigen::Vector2d part = components(sum, place({before, after}), place({across_before, across_after}));
  c[0].coefficient += part[0];
  c[2].coefficient -= part[0];
  c[3].coefficient = part[1];
  c[4].coefficient = -part[1];
  return found;
}

CellDifference Metric::mixed_difference(const Cell& cell) const {
  const auto& k = cell.corner;
  CellDifference found{{{{k[0][0], 1}, {k[0][1], -1}, {k[1][0], -1}, {k[1][1], 1}}},
                       (length(cell.lower()) + length(cell.upper())) / 2,
                       (length(cell.left()) + length(cell.right())) / 2};
  if (grid_.uniform()) return found;

  const Eigen::Vector2d part = components(place(cell.upper()) - place(cell.lower()), place(cell.lower()) + place(cell.upper()),
                                          place(cell.left()) + place(cell.right()));
  for (const int a : {0, 1})
    for (const int b : {0, 1}) found.entries[2 * a + b].coefficient -= (2 * a - 1) * part[0] + (2 * b - 1) * part[1];
  return found;
}

}  // namespace drape::model
