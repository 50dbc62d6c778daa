// Lengths, areas and differences of panels.

#include "model/sheet/metric.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "verify/support/convergence.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/panels.hpp"

namespace drape::verify::metric_test {
namespace {

using model::Metric;
using namespace sheets;
using panels::inner;
using panels::outer;
using panels::sector;

constexpr double rounding = 1000 * std::numeric_limits<double>::epsilon();

/// Each direction's strips, the cells and what particles stand for cover the panel once.
TEST(Metric, HasAreasThatAddUpToThePanel) {
  for (const Grid& grid : {five_by_four(), graded(), curved(), sector(7)}) {
    const Metric metric(grid);
    const double whole = grid.cell_areas().sum();
    double weft = 0, warp = 0, cells_area = 0;
    for (const model::Edge& edge : edges(grid)) (edge.weft ? weft : warp) += edge.length * edge.width;
    for (const model::Cell& cell : cells(grid)) cells_area += metric.area(cell);
    for (const double area : {weft, warp, cells_area, grid.quad_areas(grid.parameters()).sum()})
      EXPECT_NEAR(area, whole, rounding * whole);
    for (const model::Edge& edge : edges(grid)) EXPECT_NEAR(metric.length({edge.i, edge.j}), edge.length, rounding);
  }
  EXPECT_NEAR(graded().cell_areas().sum(), 0.6, rounding);
}

/// As the algorithms of the thesis print it: particles and edges on borders stand for as much as those beside them.
TEST(Metric, HasWholeCellsOnBordersIfItIsAsked) {
  Grid grid = curved();
  const Eigen::VectorXd dual = grid.cell_areas();
  const std::vector<model::Edge> dual_edges = edges(grid);
  grid.border_cells = model::BorderCells::whole;
  const Eigen::VectorXd whole = grid.cell_areas();
  const auto at_end = [](int place, int n) { return place == 0 || place == n - 1; };
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const int i = grid.index(a, b);
      EXPECT_NEAR(whole[i], (at_end(a, grid.nu) ? 2 : 1) * (at_end(b, grid.nv) ? 2 : 1) * dual[i], rounding);
    }
  const std::vector<model::Edge> whole_edges = edges(grid);
  for (std::size_t k = 0; k < dual_edges.size(); ++k) {
    const model::Edge& edge = dual_edges[k];
    const bool border = edge.weft ? at_end(edge.i / grid.nu, grid.nv) : at_end(edge.i % grid.nu, grid.nu);
    EXPECT_NEAR(whole_edges[k].width, (border ? 2 : 1) * edge.width, rounding);
  }
}

/// A rectangle in a box that is a square.
TEST(Metric, KnowsTheShortestEdges) {
  const Eigen::Vector2d u(0.6, 0.6), v(-0.1, 0.1);
  Grid grid{4, 3, 0.7, 0.7};
  grid.outline = model::parallelogram(u, v);
  const auto [weft, warp] = shortest_edges(grid);
  EXPECT_NEAR(weft, u.norm() / 3, rounding);
  EXPECT_NEAR(warp, v.norm() / 2, rounding);
}

TEST(Metric, AreaOfASectorIsOfOrderTwo) {
  Convergence c;
  const double exact = std::numbers::pi / 4 * (outer * outer - inner * inner);
  for (const int n : {5, 9, 17, 33}) {
    c.steps.push_back(1.0 / (n - 1));
    c.errors.push_back(std::abs(sector(n).cell_areas().sum() - exact));
  }
  EXPECT_TRUE(has_order(c, 2));
}

template <class Entries>
Eigen::RowVector3d sum(const Entries& entries, const Vectors& x) {
  Eigen::RowVector3d total = Eigen::RowVector3d::Zero();
  for (const auto& [particle, coefficient] : entries) total += coefficient * x.row(particle);
  return total;
}

TEST(Metric, DifferencesVanishOnAffineImages) {
  for (const Grid& grid : {five_by_four(), graded(), curved(), sector(6)}) {
    const Metric metric(grid);
    const Vectors uv = grid.parameters();
    const Vectors x = uv.col(0) * Eigen::RowVector3d(1.1, 0.2, 0.3) + uv.col(1) * Eigen::RowVector3d(0.3, 0.9, -0.4);
    for (int b = 0; b < grid.nv; ++b)
      for (int a = 0; a < grid.nu; ++a) {
        const auto vanishes = [&](bool weft) {
          EXPECT_LE(largest(sum(metric.second_difference(a, b, weft).entries, x)), rounding) << a << ' ' << b;
        };
        if (a > 0 && a < grid.nu - 1) vanishes(true);
        if (b > 0 && b < grid.nv - 1) vanishes(false);
      }
    for (const model::Cell& cell : cells(grid)) EXPECT_LE(largest(sum(metric.mixed_difference(cell).entries, x)), rounding);
  }
}

/// z = u² + 3 u v − 2 v² on a rectangle with spacings that grow.
TEST(Metric, DifferencesOfQuadraticsAreExactOnGradedRectangles) {
  const Grid grid = graded();
  const Metric metric(grid);
  Vectors x = grid.parameters();
  x.col(2) = x.col(0).array().square() + 3 * x.col(0).array() * x.col(1).array() - 2 * x.col(1).array().square();
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a)
      for (const bool weft : {true, false}) {
        if (weft ? a == 0 || a == grid.nu - 1 : b == 0 || b == grid.nv - 1) continue;
        const auto [entries, length] = metric.second_difference(a, b, weft);
        EXPECT_NEAR(sum(entries, x)[2] / (length * length), weft ? 2 : -4, rounding);
      }
  for (const model::Cell& cell : cells(grid)) {
    const auto [entries, lu, lv] = metric.mixed_difference(cell);
    EXPECT_NEAR(sum(entries, x)[2] / (lu * lv), 3, rounding);
  }
}

}  // namespace
}  // namespace drape::verify::metric_test
