// Scalar strains: values of simple shapes, and derivatives against differences.

#include "model/sheet/strain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "verify/support/model_fixtures.hpp"

namespace drape::verify::strain_test {
namespace {

using model::Strain;
using namespace sheets;

std::vector<Strain> strains(const Grid& grid) {
  std::vector<Strain> all;
  const model::Metric metric(grid);
  for (const model::Edge& edge : edges(grid)) all.push_back(Strain::of_edge(edge));
  for (const model::Cell& cell : cells(grid)) {
    for (const auto& [p, q] : quadrants(cell)) {
      all.push_back(Strain::of_quadrant(metric, cell, p, q));
      all.push_back(Strain::of_angle(metric, cell, p, q));
    }
    all.push_back(Strain::of_twist(metric, cell));
  }
  for (const model::LineCurvature& curvature : line_curvatures(grid)) all.push_back(curvature.strain);
  return all;
}

TEST(Strain, HasTheDerivativesThatDifferencesShow) {
  constexpr double step = 1e-6;
  const Grid grid = five_by_four();
  const State y = deformed(grid, 1);
  std::vector<Strain> all = strains(grid);
  std::ranges::copy(strains(curved()), std::back_inserter(all));
  Strain::Gradient by, above, below;
  Strain::Hessian second;
  for (const Strain& strain : all) {
    double rate = 0;
    const double value = strain.value(y.x, by);
    EXPECT_EQ(value, strain.value(y.x));
    strain.second_derivatives(y.x, second);
    for (int j = 0; j < strain.count(); ++j) {
      rate += by[j].dot(y.v.row(strain.particle(j)));
      for (int c = 0; c < 3; ++c) {
        Vectors x = y.x;
        x(strain.particle(j), c) += step;
        const double up = strain.value(x, above);
        x(strain.particle(j), c) -= 2 * step;
        const double down = strain.value(x, below);
        // A particle may have two places.
        double slope = 0;
        for (int k = 0; k < strain.count(); ++k) slope += strain.particle(k) == strain.particle(j) ? by[k][c] : 0;
        EXPECT_NEAR((up - down) / (2 * step), slope, 1e-6 * (1 + std::abs(slope)));
        for (int k = 0; k < strain.count(); ++k) {
          Eigen::Vector3d column = Eigen::Vector3d::Zero();
          for (int i = 0; i < strain.count(); ++i)
            if (strain.particle(i) == strain.particle(j)) column += second[k][i].col(c);
          EXPECT_LT(((above[k] - below[k]) / (2 * step) - column).norm(), 1e-5 * (1 + column.norm()));
        }
      }
    }
    EXPECT_NEAR(strain.rate(y.x, y.v), rate, 1e-12 * (1 + std::abs(rate)));
  }
}

/// A sheet that is stretched and sheared, and arcs along weft and warp whose chords are the edges.
TEST(Strain, IsThatOfSimpleShapes) {
  const Grid grid{6, 5, 1, 0.6};
  const model::Metric metric(grid);
  Vectors x = grid.parameters();
  x.col(0) = 1.2 * grid.parameters().col(0) + 0.3 * grid.parameters().col(1);
  for (const model::Edge& edge : edges(grid))
    EXPECT_NEAR(Strain::of_edge(edge).value(x), edge.weft ? 0.2 : std::hypot(1, 0.3) - 1, 1e-14);
  for (const model::Cell& cell : cells(grid))
    for (const auto& [p, q] : quadrants(cell)) EXPECT_NEAR(Strain::of_quadrant(metric, cell, p, q).value(x), 1.2 * 0.3, 1e-14);
  for (const model::Cell& cell : cells(grid))
    for (const auto& [p, q] : quadrants(cell))
      EXPECT_NEAR(Strain::of_angle(metric, cell, p, q).value(x), std::atan(0.3), 1e-14);

  for (const bool weft : {true, false}) {
    constexpr double angle = 0.3;  // between edges
    const double l = weft ? grid.spacing_u() : grid.spacing_v(), R = l / (2 * std::sin(angle / 2));
    for (int b = 0; b < grid.nv; ++b)
      for (int a = 0; a < grid.nu; ++a) {
        const double place = angle * (weft ? a : b), other = weft ? b * grid.spacing_v() : a * grid.spacing_u();
        x.row(grid.index(a, b)) = weft ? Eigen::RowVector3d(R * std::sin(place), other, R * (1 - std::cos(place)))
                                       : Eigen::RowVector3d(other, R * std::sin(place), R * (1 - std::cos(place)));
      }
    const double exact = 2 * std::sin(angle / 2) / l;  // 1/R
    for (int b = 1; b < grid.nv - 1; ++b)
      for (int a = 1; a < grid.nu - 1; ++a) {
        EXPECT_NEAR(Strain::of_curvature(metric, a, b, weft).value(x), exact, 1e-12);
        EXPECT_NEAR(Strain::of_curvature(metric, a, b, !weft).value(x), 0, 1e-12);
      }
    for (const model::Cell& cell : cells(grid)) EXPECT_NEAR(Strain::of_twist(metric, cell).value(x), 0, 1e-12);
  }
  x = grid.parameters();
  x.col(2) = 1e-4 * x.col(0).cwiseProduct(x.col(1));
  for (const model::Cell& cell : cells(grid)) EXPECT_NEAR(Strain::of_twist(metric, cell).value(x), 1e-4, 1e-11);
}

/// So that energies of homogeneous strains are those of the sheet.
TEST(Strain, StandsForAreasThatAddUpToTheSheet) {
  const Grid grid = five_by_four();
  const model::Metric metric(grid);
  double weft = 0, warp = 0, shear = 0;
  for (const model::Edge& edge : edges(grid)) (edge.weft ? weft : warp) += Strain::of_edge(edge).area();
  for (const model::Cell& cell : cells(grid))
    for (const auto& [p, q] : quadrants(cell)) shear += Strain::of_quadrant(metric, cell, p, q).area();
  for (const double area : {weft, warp, shear}) EXPECT_NEAR(area, grid.size_u * grid.size_v, 1e-14);
}

}  // namespace
}  // namespace drape::verify::strain_test
