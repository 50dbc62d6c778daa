// The forces of the grid in one pass: whatever the size of the grid and the terms that act, they are the sum of the terms.

#include "model/forces/fused/fused_forces.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "verify/support/model_fixtures.hpp"
#include "verify/support/threads.hpp"

namespace drape::verify::fused_forces_test {
namespace {

using namespace sheets;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

const Material everything = made_of(tension, projected_damping, shear, contraction);

SplitOde ode_with(const Material& material, const Grid& grid, const Eigen::Vector3d& gravity = Eigen::Vector3d::Zero()) {
  Scene scene;
  scene.sheet.grid = grid;
  scene.sheet.material = material;
  scene.sheet.gravity = gravity;
  return model::compile(scene).ode;
}

/// The same sheet with weft and warp changed over.
Material transposed(Material m) {
  for (model::WeftWarp* modulus : {&m.tension, &m.damping}) std::swap(modulus->weft, modulus->warp);
  return m;
}
Vectors transposed(const Vectors& x, const Grid& grid) {
  Vectors y(x.rows(), 3);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) y.row(b + grid.nv * a) = x.row(grid.index(a, b));
  return y;
}

/// Lines of one to several blocks of columns, with all remainders, beside many lines of few columns.
TEST(FusedForces, IsTheSameAlongWeftAndWarp) {
  const Eigen::Vector3d g(0.5, -0.3, -2);
  for (int n : {2, 3, 7, 8, 9, 15, 16, 17, 119, 120, 121, 127, 128, 129, 135, 136, 137, 255, 256, 257, 300})
    for (int m : {1, 2, 3, 4}) {
      const Grid wide{n, m, 0.1 * n, 0.12 * m}, tall{m, n, 0.12 * m, 0.1 * n};
      const State y = deformed(wide, 1);
      const Vectors f = evaluate(ode_with(everything, wide, g).force, y);
      const State turned{transposed(y.x, wide), transposed(y.v, wide)};
      const Vectors f_turned = evaluate(ode_with(transposed(everything), tall, g).force, turned);
      EXPECT_LE(largest(transposed(f, wide) - f_turned), 100 * epsilon * largest(f)) << n << " × " << m;
    }
}

/// Grids that do not fit into a cache are cut into other blocks.
TEST(FusedForces, HasNoForcesInsideAHomogeneousStrainOfALargeGrid) {
  const Grid grid{211, 101, 2.1, 1};
  const Vectors uv = grid.parameters();
  const Vectors x = uv.col(0) * Eigen::RowVector3d(1.1, 0.2, 0.1) + uv.col(1) * Eigen::RowVector3d(0.3, 0.9, -0.2);
  const Vectors f = evaluate(ode_with(everything, grid).force, {x, at_rest(x)});
  for (int b = 1; b < grid.nv - 1; ++b)
    EXPECT_LE(largest(f.middleRows(grid.index(1, b), grid.nu - 2)), 1e-10 * largest(f)) << "line " << b;
}

/// Bands of lines of a grid with and without spacings of its own.
TEST(FusedForces, IsTheSameForAnyNumberOfThreads) {
  for (const double grading : {1.0, 1.5})
    for (const auto& [nu, nv] : {std::pair{211, 201}, {1200, 35}}) {
      Grid grid{nu, nv, 2.1, 1};
      grid.grading_u = grid.grading_v = grading;
      const SplitOde ode = ode_with(everything, grid, {0.5, -0.3, -2});
      const State y = deformed(grid, 3);
      const Vectors by_one = evaluate(ode.force, y);
      for (const int threads : {2, 3, 7}) {
        const Threads allowed(threads);
        ASSERT_EQ(base::threads_for(grid.particles()), threads);
        EXPECT_EQ(evaluate(ode.force, y), by_one) << threads << " threads, " << nu << " x " << nv << ", grading " << grading;
      }
    }
}

TEST(FusedForces, AddsUpAllCombinationsOfTerms) {
  using Part = void (*)(Material&);
  const Part parts[] = {tension, linear_damping, shear, contraction, projected_damping};
  const Grid grid = five_by_four();
  const State y = deformed(grid, 2);
  for (unsigned chosen = 0; chosen < 32; ++chosen) {
    Material all;
    Vectors whole = at_rest(y.x), rest = whole;
    for (unsigned k = 0; k < 5; ++k) {
      if ((chosen >> k & 1) == 0) continue;
      if (k == 4 && (chosen & 2) != 0) continue;  // damping has one form
      parts[k](all);
      const SplitOde ode = ode_with(made_of(parts[k]), grid);
      whole += evaluate(ode.force, y);
      rest += evaluate(ode.explicit_force, y);
    }
    const SplitOde ode = ode_with(all, grid);
    EXPECT_LE(largest(evaluate(ode.force, y) - whole), 100 * epsilon * largest(whole)) << chosen;
    EXPECT_LE(largest(evaluate(ode.explicit_force, y) - rest), 100 * epsilon * largest(rest)) << chosen;
  }
}

TEST(FusedForces, ForgetsWhatItEvaluatedBefore) {
  for (const Grid& grid : {five_by_four(), Grid{137, 3, 13.7, 0.3}, Grid{1, 5, 0.2, 1}, Grid{6, 1, 1, 0.25}}) {
    const State y = deformed(grid, 3);
    const SplitOde ode = ode_with(everything, grid);
    const Vectors f = evaluate(ode.force, y);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vectors nothing = Vectors::Constant(grid.particles(), 3, nan);
    EXPECT_TRUE(evaluate(ode.force, {nothing, nothing}).hasNaN());
    EXPECT_EQ(evaluate(ode.force, y), f);
  }
}

TEST(FusedForces, ReadsVelocitiesOnlyIfTheLawAsks) {
  const Grid grid = five_by_four();
  State y = deformed(grid, 4);
  Vectors f = y.x;
  const auto forces = [&](const model::GridLaw& law) -> const Vectors& {
    model::FusedForces(grid, law)(y.x, y.v, f);
    return f;
  };
  y.v.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(forces({.edge = {.spring = {1, 0}, .preload = {1, 0}}, .cell = {.shear = 1, .contraction = 1}}).allFinite());
  for (const model::GridLaw& law : {model::GridLaw{.edge = {.drag = {1, 0}}},
                                    {.edge = {.dashpot = {0, 1}}},
                                    {.cell = {.shear_rate = 1}},
                                    {.cell = {.contraction_rate = 1}}})
    EXPECT_TRUE(forces(law).hasNaN());
}

}  // namespace
}  // namespace drape::verify::fused_forces_test
