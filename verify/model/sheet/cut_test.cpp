// Sheets that are cut along a curve.

#include "model/sheet/cut.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "model/sheet/strain.hpp"
#include "solver/integrator.hpp"
#include "solver/methods.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::cut_test {
namespace {

using Eigen::Vector2d;
using model::CurvePiece;
using model::Metric;
using namespace sheets;

constexpr double rounding = 1000 * std::numeric_limits<double>::epsilon();

std::vector<CurvePiece> closed(const std::vector<Vector2d>& corners) {
  std::vector<CurvePiece> curve;
  for (std::size_t k = 0; k < corners.size(); ++k)
    curve.push_back({CurvePiece::Kind::line, {corners[k], corners[(k + 1) % corners.size()]}});
  return curve;
}

constexpr double radius = 0.4;

/// A disc in a square of side 1.
Grid disc(int n) {
  using enum CurvePiece::Kind;
  Grid grid{n, n, 1, 1};
  const double c = 0.5, r = radius;
  grid.cut = {{arc, {{c + r, c}, {c, c + r}, {c - r, c}}}, {arc, {{c - r, c}, {c, c - r}, {c + r, c}}}};
  return grid;
}

TEST(Cuts, HaveTheAreasOfTheirPolygons) {
  const double exact = std::numbers::pi * radius * radius;
  for (const int n : {5, 12, 33}) EXPECT_NEAR(disc(n).cell_areas().sum(), exact, 2e-6 * exact) << n;
  const std::vector<Vector2d> clockwise{{0, 0}, {0, 1}, {1, 0}};
  EXPECT_EQ(model::polygon_area(clockwise), -0.5);
  EXPECT_EQ(model::polygon_area(model::closed_polygon(closed(clockwise))), 0.5);
}

/// A notch that leaves two parts of a cell.
TEST(Cuts, LeavePartsOfCells) {
  Grid grid{3, 2, 2, 1};
  grid.cut = closed({{0.25, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 0.5}, {1, 0.5}});
  const Eigen::VectorXd areas = grid.quad_areas(grid.parameters());
  EXPECT_NEAR(areas[0], 1 - (0.5 - 0.75 * 0.5 / 2), rounding);
  EXPECT_EQ(areas[1], 1);
  grid.cut = closed({{0, 0.2}, {2, 0.2}, {2, 1}, {0, 1}});
  EXPECT_NEAR(grid.quad_areas(grid.parameters())[0], 0.8, rounding);
  EXPECT_NEAR(grid.cell_areas()[0], 0.2, rounding);
}

/// The strips of each direction, cells, and what particles stand for cover the cloth once.
TEST(Cuts, HaveAreasThatAddUpToTheCloth) {
  for (const Grid& grid : {cut(), disc(9)}) {
    const Metric metric(grid);
    const double whole = grid.cell_areas().sum();
    double weft = 0, warp = 0, in_cells = 0;
    for (const model::Edge& edge : edges(grid)) (edge.weft ? weft : warp) += edge.length * edge.width;
    for (const model::Cell& cell : cells(grid)) in_cells += metric.area(cell);
    for (const double area : {weft, warp, in_cells}) EXPECT_NEAR(area, whole, rounding);
  }
}

/// Energies of homogeneous strains are those of a continuum on the area of the polygon.
TEST(Cuts, HaveTheEnergiesOfHomogeneousStrains) {
  const double area = disc(9).cell_areas().sum(), e1 = 0.02, e2 = 0.03, gamma = 0.05;
  Scene scene;
  scene.sheet.grid = disc(9);
  scene.sheet.material = made_of(tension, shear, contraction);
  const Material& m = scene.sheet.material;
  const Vectors uv = scene.sheet.grid.parameters();
  const Vectors stretched = uv.col(0) * Eigen::RowVector3d(1 + e1, 0, 0) + uv.col(1) * Eigen::RowVector3d(0, 1 + e2, 0);
  EXPECT_NEAR(model::compile(scene).ode.potential_energy(0, stretched),
              area * (m.tension.weft * e1 * e1 / 2 + m.tension.warp * e2 * e2 / 2 + m.contraction * e1 * e2), rounding);
  const Vectors sheared =
      uv.col(0) * Eigen::RowVector3d(1, 0, 0) + uv.col(1) * Eigen::RowVector3d(gamma, std::sqrt(1 - gamma * gamma), 0);
  EXPECT_NEAR(model::compile(scene).ode.potential_energy(0, sheared), area * m.shear * gamma * gamma / 2, rounding);
}

/// z = u²/2 + v²: strips along the border end half a cell before it.
TEST(Cuts, HaveEnergiesOfBendingOfOrderOne) {
  DRAPE_SLOW();
  const double exact = std::numbers::pi * radius * radius * (0.06 * 1 + 0.04 * 4) / 2;
  Convergence c;
  for (const int n : {21, 41, 81, 161, 321}) {
    Scene scene;
    scene.sheet.grid = disc(n);
    scene.sheet.material = made_of(unprojected_plate);
    Vectors x = scene.sheet.grid.parameters();
    x.col(2) = x.col(0).array().square() / 2 + x.col(1).array().square();
    c.steps.push_back(1.0 / (n - 1));
    c.errors.push_back(std::abs(model::compile(scene).ode.potential_energy(0, x) - exact));
  }
  EXPECT_LE(c.errors.back(), 0.01 * exact);
  for (std::size_t k = 1; k < c.errors.size(); ++k) EXPECT_LE(c.errors[k], 0.6 * c.errors[k - 1]) << k;
}

/// The largest eigenvalue of M⁻¹ B of a plate, by powers: of slivers of all sizes it is not much larger than that of the
/// square.
TEST(Cuts, StiffenBendingByAFewTimesOnly) {
  const auto largest_of = [](const Grid& grid) {
    Scene scene;
    scene.sheet.grid = grid;
    scene.sheet.material = made_of(unprojected_plate);
    const SplitOde ode = model::compile(scene).ode;
    State y{random_vectors(grid.particles(), 1, 1), at_rest(grid.parameters())};
    double value = 0;
    for (int k = 0; k < 200; ++k) {
      y.x = ode.mass.cwiseInverse().asDiagonal() * evaluate(ode.force, y);
      value = y.x.norm();
      y.x /= value;
    }
    return value;
  };
  const double of_square = largest_of({12, 12, 1, 1});
  for (int k = 0; k < 12; ++k) {
    Grid grid = disc(12);
    for (CurvePiece& piece : grid.cut)
      for (Vector2d& point : piece.points) point += Vector2d(0.007 * k, 0.004 * k);
    EXPECT_LE(largest_of(grid), 4 * of_square) << k;
  }
}

/// What a cut along lines of the grid leaves is a smaller rectangle: the same forces, and the same motions.
TEST(Cuts, AlongLinesLeaveRectangles) {
  const Grid whole{7, 6, 1.2, 1}, rectangle{4, 4, 0.6, 0.6};
  Grid grid = whole;
  grid.cut = closed({{0.4, 0.2}, {1, 0.2}, {1, 0.8}, {0.4, 0.8}});
  const auto place = [&](int i) { return whole.index(2 + i % rectangle.nu, 1 + i / rectangle.nu); };
  for (const ForceCase& force : force_cases()) {
    if (!exists_on(grid, force)) continue;
    const SplitOde expected = ode_of(force, rectangle), ode = ode_of(force, grid);
    const State y = deformed(rectangle, 1);
    State of_whole = deformed(whole, 2);
    for (int i = 0; i < rectangle.particles(); ++i) {
      of_whole.x.row(place(i)) = y.x.row(i), of_whole.v.row(place(i)) = y.v.row(i);
      EXPECT_NEAR(ode.mass[place(i)], expected.mass[i], rounding);
    }
    const Vectors f = evaluate(expected.force, y), of_cut = evaluate(ode.force, of_whole);
    Vectors left = of_cut, moved = Vectors::Zero(f.rows(), 3);
    for (int i = 0; i < rectangle.particles(); ++i) moved.row(i) = of_cut.row(place(i)), left.row(place(i)).setZero();
    EXPECT_LE(largest(moved - f), rounding * largest(f)) << force.name;
    EXPECT_EQ(largest(left), 0) << force.name;
    EXPECT_EQ(std::ssize(ode.pins), whole.particles() - rectangle.particles());
    for (const solver::Pin& pin : ode.pins) EXPECT_TRUE(pin.fixed(0) && pin.fixed(1) && pin.fixed(2));
  }
}

TEST(Cuts, MoveAsTheRectanglesThatTheyLeave) {
  const Grid rectangle{4, 4, 0.6, 0.6};
  Scene small, large;
  small.sheet = {rectangle, made_of(tension, linear_damping, shear, unprojected_plate), {0, 0, -9.81}};
  small.pins = {{.where = "upper edge", .particles = {}}};
  large = small;
  large.sheet.grid = {7, 6, 1.2, 1};
  large.sheet.grid.cut = closed({{0.4, 0.2}, {1, 0.2}, {1, 0.8}, {0.4, 0.8}});
  large.pins = {{.where = {}, .particles = {{2, 4}, {3, 4}, {4, 4}, {5, 4}}}};
  for (const char* name : {"imex-euler", "bdf2", "verlet", "xpbd", "bridson", "ros3p"}) {
    std::vector<Vectors> ends;
    for (const Scene& scene : {small, large}) {
      const model::Cloth cloth = model::compile(scene);
      solver::Integrator integrator(cloth.ode, solver::method(name), {}, cloth.start);
      for (int k = 0; k < 20; ++k) ASSERT_EQ(integrator.step(0.002).outcome, solver::Outcome::success) << name;
      ends.push_back(integrator.state().x);
    }
    const Vectors at_start = large.sheet.grid.parameters();
    for (int i = 0; i < at_start.rows(); ++i) {
      const int a = i % 7 - 2, b = i / 7 - 1;
      const bool in_cloth = a >= 0 && a < 4 && b >= 0 && b < 4;
      Eigen::RowVector3d expected = at_start.row(i);
      if (in_cloth) expected = ends[0].row(a + 4 * b) + Eigen::RowVector3d(0.4, 0.2, 0);
      EXPECT_LE((ends[1].row(i) - expected).norm(), 1e-7) << name << ' ' << i;
    }
    EXPECT_GT(largest(ends[0] - rectangle.parameters()), 1e-3);
  }
}

TEST(Cuts, ThatCrossThemselvesAreFound) {
  const std::vector<Vector2d> bow{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_TRUE(model::crosses_itself(bow));
  EXPECT_FALSE(model::crosses_itself(model::closed_polygon(disc(5).cut)));
  const std::vector<Vector2d> notched{{0, 0}, {2, 0}, {2, 1}, {1, 0.2}, {0, 1}};  // lines cross sides, sides do not
  EXPECT_FALSE(model::crosses_itself(notched));
}

}  // namespace
}  // namespace drape::verify::cut_test
