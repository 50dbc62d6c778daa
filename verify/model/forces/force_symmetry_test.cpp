// What forces may not depend on: the place, the orientation and the names of the directions. What they must keep: momentum
// and angular momentum, and no viscous force may gain energy. The table of forces says where the model does not keep this.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "model/sheet/normals.hpp"
#include "solver/base/decompositions.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::force_symmetry_test {
namespace {

using namespace sheets;
using testing::TestWithParam;
using testing::ValuesIn;

/// What rounding leaves of sums over a sheet that are zero, relative to the largest summand. What is not zero in a random
/// state is far above `much`.
constexpr double rounding = 1000 * std::numeric_limits<double>::epsilon();
constexpr double much = 1e-3;

const Eigen::Vector3d shift(0.3, -0.2, 0.5), spin(0.7, -0.4, 0.9);
const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();

Vectors shifted(const Vectors& x, const Eigen::Vector3d& by) { return x.rowwise() + by.transpose(); }
Vectors turned(const Vectors& x) { return x * turn.transpose(); }
Vectors rotation(const Vectors& x) { return -x.rowwise().cross(spin.transpose()); }

/// Mirrored at the line through the origin that halves the angle between the axes.
Grid transposed(const Grid& grid) {
  Grid other{grid.nv, grid.nu, grid.size_v, grid.size_u};
  other.grading_u = grid.grading_v, other.grading_v = grid.grading_u;
  other.outline = {
      .lower = grid.outline.left, .upper = grid.outline.right, .left = grid.outline.lower, .right = grid.outline.upper};
  other.cut = grid.cut;
  for (auto* side : {&other.outline.lower, &other.outline.upper, &other.outline.left, &other.outline.right, &other.cut})
    for (model::CurvePiece& piece : *side)
      for (Eigen::Vector2d& point : piece.points) std::swap(point.x(), point.y());
  return other;
}

Eigen::Vector3d total(const Vectors& f) { return f.colwise().sum(); }
Eigen::Vector3d torque(const Vectors& x, const Vectors& f) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.rows(); ++i) sum += x.row(i).cross(f.row(i));
  return sum;
}

/// Zero up to rounding, or clearly not: `size` is what it is measured by.
testing::AssertionResult vanishes(bool expected, double value, double size) {
  if (std::abs(value) <= rounding * size) return testing::AssertionResult(expected) << "is zero";
  if (std::abs(value) >= much * size) return testing::AssertionResult(!expected) << "is not zero: " << value / size;
  return testing::AssertionFailure() << "is neither zero nor clearly not: " << value / size;
}

class SymmetryOf : public TestWithParam<Sheet> {
 protected:
  const ForceCase& force = GetParam().force;
  const Grid grid = GetParam().grid.grid;
  const SplitOde ode = ode_of(force, grid);
  const State y = deformed(grid, 1);
  const Vectors f = evaluate(ode.force, y);
  const double size = largest(f) + std::numeric_limits<double>::min();
};
INSTANTIATE_TEST_SUITE_P(, SymmetryOf, ValuesIn(sheets_where([](const Sheet&) { return true; })), name_of);

TEST_P(SymmetryOf, ShiftedSheetsHaveTheSameForcesAndEnergy) {
  const State moved{shifted(y.x, shift), force.air == 0 ? shifted(y.v, spin) : y.v};  // the air is at rest
  EXPECT_LE(largest(evaluate(ode.force, moved) - f), rounding * size);
  const double work = force.material.density * grid.cell_areas().sum() * force.gravity.dot(shift);
  const double energy = ode.potential_energy(0, y.x);
  EXPECT_NEAR(ode.potential_energy(0, moved.x), energy - work, rounding * (std::abs(energy) + std::abs(work)));
}

TEST_P(SymmetryOf, TurnedSheetsHaveTurnedForcesAndTheSameEnergy) {
  ForceCase also_turned = force;
  also_turned.gravity = turn * force.gravity;
  also_turned.wind.load = turn * force.wind.load;
  const SplitOde turned_ode = ode_of(also_turned, grid);
  const State moved{turned(y.x), turned(y.v)};
  EXPECT_LE(largest(evaluate(turned_ode.force, moved) - turned(f)), rounding * size);
  const double energy = ode.potential_energy(0, y.x);
  EXPECT_NEAR(turned_ode.potential_energy(0, moved.x), energy, rounding * std::abs(energy));
}

/// The sheet with weft and warp exchanged: particle (a, b) becomes (b, a).
TEST_P(SymmetryOf, WeftAndWarpAreAlike) {
  const auto exchanged = [](auto modulus) { return model::WeftWarp{modulus.warp, modulus.weft}; };
  ForceCase other = force;
  for (const auto modulus : {&Material::tension, &Material::damping, &Material::bend, &Material::bend_damping})
    other.material.*modulus = exchanged(force.material.*modulus);
  std::swap(other.material.weft_curve, other.material.warp_curve);
  std::swap(other.material.weft_bend_curve, other.material.warp_bend_curve);
  other.material.friction.bend = exchanged(force.material.friction.bend);
  model::FabricTables& tables = other.material.tables;
  for (auto& [C11, C12, C22, C33] : tables.stretching) std::swap(C11, C22);
  std::reverse(tables.stretching.begin() + 1, tables.stretching.end());  // 0 to 90 degrees
  std::reverse(tables.bending.begin(), tables.bending.end());
  const Grid flipped = transposed(grid);
  const auto flip = [&](const Vectors& field) {
    Vectors result(field.rows(), 3);
    for (int b = 0; b < grid.nv; ++b)
      for (int a = 0; a < grid.nu; ++a) result.row(flipped.index(b, a)) = field.row(grid.index(a, b));
    return result;
  };
  const SplitOde flipped_ode = ode_of(other, flipped);
  EXPECT_LE(largest(evaluate(flipped_ode.force, {flip(y.x), flip(y.v)}) - flip(f)), rounding * size);
  const double energy = ode.potential_energy(0, y.x);
  EXPECT_NEAR(flipped_ode.potential_energy(0, flip(y.x)), energy, rounding * std::abs(energy));
}

/// Two sheets, with borders and an inside, for each force.
class PhysicsOf : public SymmetryOf {
 protected:
  const Vectors elastic = evaluate(ode.force, {y.x, at_rest(y.x)});
  const Vectors viscous = f - elastic;

  Eigen::MatrixXd by_velocities() const {
    SparseMatrix dx, dv;
    ode.jacobian(0, y.x, y.v, dx, dv);
    return dv;
  }
};
INSTANTIATE_TEST_SUITE_P(, PhysicsOf,
                         ValuesIn(sheets_where([](const Sheet& s) { return s.grid.name == "5x4" || s.grid.name == "curved"; })),
                         name_of);

TEST_P(PhysicsOf, ForcesSumToZeroWhereTheTableSaysSo) { EXPECT_TRUE(vanishes(force.keeps_momentum, total(f).norm(), size)); }

TEST_P(PhysicsOf, TorquesSumToZeroWhereTheTableSaysSo) {
  const double length = largest(y.x);
  EXPECT_TRUE(vanishes(force.keeps_angular, torque(y.x, elastic).norm(), length * size)) << "elastic";
  if (largest(viscous) == 0) return;
  EXPECT_TRUE(vanishes(force.keeps_angular && force.ignores_rotation, torque(y.x, viscous).norm(), length * size)) << "viscous";
}

TEST_P(PhysicsOf, RotationsMeetNoViscousForceWhereTheTableSaysSo) {
  const Vectors rotating = evaluate(ode.force, {y.x, rotation(y.x)}) - elastic;
  EXPECT_TRUE(vanishes(force.ignores_rotation, largest(rotating), size));
}

/// Forces linear in v have a quadratic form for their power: no velocity at all may give it a positive value.
TEST_P(PhysicsOf, ViscousForcesDissipateWhereTheTableSaysSo) {
  if (force.name == "air") return;  // its power, which is no quadratic form, has a test in wind_test.cpp
  const Eigen::MatrixXd dv = by_velocities(), form = (dv + dv.transpose()) / 2;
  const double greatest = base::symmetric_eigen(form).values.maxCoeff();
  if (force.dissipates) {
    EXPECT_LE(greatest, rounding * largest(dv));
  } else if (grid.uniform()) {
    EXPECT_GE(greatest, much * largest(dv));
  }
}

/// Alg. 2 pulls along unit vectors, so that the couples of a particle, σ|s_u| and σ|s_v|, do not cancel. Its forces do, where
/// all neighbours have dual cells of one size.
TEST(Physics, PrintedShearMakesATorqueAlsoFarFromBorders) {
  const Grid grid{10, 9, 1, 1};
  Vectors x = grid.parameters();
  const Vectors moved = deformed(grid, 1).x;
  for (int b = 3; b < grid.nv - 3; ++b)
    for (int a = 3; a < grid.nu - 3; ++a) x.row(grid.index(a, b)) = moved.row(grid.index(a, b));
  const Vectors f = evaluate(ode_of(force_case("printed_shear"), grid).force, {x, at_rest(x)});
  EXPECT_TRUE(vanishes(true, total(f).norm(), largest(f)));
  EXPECT_TRUE(vanishes(false, torque(x, f).norm(), largest(f) * spacing(grid)));
}

TEST(Physics, ProjectedPlatesDissipateWhileFlat) {
  const Grid grid = five_by_four();
  const SplitOde ode = ode_of(force_case("plate"), grid);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Vectors v = deformed(grid, seed).v;
    EXPECT_LT(evaluate(ode.force, {turned(grid.parameters()), v}).cwiseProduct(v).sum(), 0);
  }
}

TEST(Physics, ForcesWithoutEnergyHaveJacobiansThatAreNotSymmetric) {
  const Grid grid = five_by_four();
  const State y{deformed(grid, 1).x, at_rest(grid.parameters())};
  for (const ForceCase& force : force_cases()) {
    const SplitOde ode = ode_of(force, grid);
    if (ode.memory) continue;  // there is an energy on each branch
    SparseMatrix dx, dv;
    ode.jacobian(0, y.x, y.v, dx, dv);
    const bool elastic = largest(Eigen::MatrixXd(dx)) > 0;
    EXPECT_TRUE(vanishes(force.has_energy || !elastic, largest(dx - SparseMatrix(dx.transpose())), largest(dx))) << force.name;
  }
}

TEST(Normals, PointOutOfTheSheetAndTurnWithIt) {
  const Grid grid = five_by_four();
  Vectors n(grid.particles(), 3), m(grid.particles(), 3);
  const model::Normals normals(grid);
  normals.evaluate(grid.parameters(), n);
  EXPECT_EQ(n, Vectors(Eigen::RowVector3d(0, 0, 1).replicate(grid.particles(), 1)));
  const Vectors x = deformed(grid, 1).x;
  normals.evaluate(x, n);
  normals.evaluate(turned(x), m);
  EXPECT_LE(largest(m - turned(n)), rounding);
  EXPECT_LE(largest(n.rowwise().norm() - Eigen::VectorXd::Ones(n.rows())), rounding);
}

}  // namespace
}  // namespace drape::verify::force_symmetry_test
