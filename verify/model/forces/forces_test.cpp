// Forces are the gradients of their energies, Jacobians the derivatives of the forces, and K x + D v + f_expl is the force.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "solver/base/decompositions.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::forces_test {
namespace {

using namespace sheets;
using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;
using testing::TestWithParam;
using testing::ValuesIn;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr unsigned seeds[] = {1, 2};

/// Central differences with steps δ and δ/2, extrapolated: their error is O(δ⁴) by truncation and O(ε/δ) by rounding. δ =
/// ε^(1/5) of the spacing balances the two at ε^(4/5). The factor allows for the fifth derivatives of edges of half their
/// length and for the rounding of sums over a sheet.
const double relative_step = std::pow(epsilon, 0.2);    // 7e-4
const double tolerance = 100 * std::pow(epsilon, 0.8);  // 3e-11

/// ∂y/∂x_k for all components k of x, one column each.
Eigen::MatrixXd differences(const std::function<Eigen::VectorXd(const Vectors&)>& y, const Vectors& x, double step) {
  const auto central = [&](Eigen::Index k, double delta) -> Eigen::VectorXd {
    Vectors ahead = x, behind = x;
    ahead.data()[k] += delta;
    behind.data()[k] -= delta;
    return (y(ahead) - y(behind)) / (2 * delta);
  };
  Eigen::MatrixXd columns(y(x).size(), x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) columns.col(k) = (4 * central(k, step / 2) - central(k, step)) / 3;
  return columns;
}

/// Whether every entry is right to the tolerance, relative to the largest entry.
AssertionResult agree(const Eigen::MatrixXd& numerical, const Eigen::MatrixXd& exact, double allowed = tolerance) {
  if (largest(numerical - exact) <= allowed * largest(numerical)) return AssertionSuccess();
  Eigen::Index row = 0, column = 0;
  (numerical - exact).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(&row, &column);
  return AssertionFailure() << "(" << row << ", " << column << ") is " << exact(row, column) << ", by differences "
                            << numerical(row, column) << ", the largest being " << largest(numerical);
}

Eigen::VectorXd flat(const Vectors& f) { return Eigen::Map<const Eigen::VectorXd>(f.data(), f.size()); }

/// The checkers: what differences say of a force.
Eigen::MatrixXd gradient(const SplitOde& ode, const State& y, double step) {
  const auto energy = [&](const Vectors& x) { return Eigen::VectorXd::Constant(1, ode.potential_energy(0, x)); };
  return differences(energy, y.x, step);
}
Eigen::MatrixXd by_positions(const SplitOde& ode, const State& y, double step) {
  return differences([&](const Vectors& x) { return flat(evaluate(ode.force, {x, y.v})); }, y.x, step);
}
Eigen::MatrixXd by_velocities(const SplitOde& ode, const State& y, double step) {
  return differences([&](const Vectors& v) { return flat(evaluate(ode.force, {y.x, v})); }, y.v, step);
}

struct Jacobian {
  SparseMatrix dx, dv;

  Jacobian(const SplitOde& ode, const State& y) { ode.jacobian(0, y.x, y.v, dx, dv); }
};

class SheetTest : public TestWithParam<Sheet> {
 protected:
  const Grid grid = GetParam().grid.grid;
  const SplitOde ode = ode_of(GetParam().force, grid);
  /// Laws that turn somewhere have derivatives of first order only, which steps must not cross: shorter ones round more.
  const bool turns = ode.memory || by_tables(GetParam().force.material);
  const double step = (turns ? 1e-6 : relative_step) * spacing(grid);
  const double allowed = turns ? 1e-6 : tolerance;
};

class ForcesOf : public SheetTest {};
INSTANTIATE_TEST_SUITE_P(, ForcesOf, ValuesIn(sheets_where([](const Sheet&) { return true; })), name_of);

class EnergyOf : public SheetTest {};
INSTANTIATE_TEST_SUITE_P(, EnergyOf, ValuesIn(sheets_where([](const Sheet& s) { return s.force.has_energy; })), name_of);

/// One sheet for each force, to see that planted errors are seen.
class CheckerOf : public SheetTest {};
INSTANTIATE_TEST_SUITE_P(, CheckerOf, ValuesIn(sheets_where([](const Sheet& s) { return s.grid.name == "3x2"; })), name_of);

TEST_P(EnergyOf, HasTheForceAsItsNegativeGradient) {
  for (const unsigned seed : seeds) {
    const State y{deformed(grid, seed).x, at_rest(grid.parameters())};
    const Eigen::MatrixXd numerical = -gradient(ode, y, step).transpose();
    const Eigen::VectorXd f = flat(evaluate(ode.force, y));
    EXPECT_TRUE(agree(numerical, f)) << "seed " << seed;
    EXPECT_FALSE(agree(numerical, 1.001 * f)) << "the checker does not see a force that is wrong";
  }
}

TEST_P(ForcesOf, HaveTheirDerivativesAsJacobians) {
  for (const unsigned seed : seeds) {
    const State y = deformed(grid, seed);
    const Jacobian jacobian(ode, y);
    EXPECT_TRUE(agree(by_positions(ode, y, step), jacobian.dx, allowed)) << "∂f/∂x, seed " << seed;
    EXPECT_TRUE(agree(by_velocities(ode, y, step), jacobian.dv, allowed)) << "∂f/∂v, seed " << seed;
  }
}

/// Also the air's resistance, of which only f(λv) = λ f(v) is true.
TEST_P(ForcesOf, AreLinearInVelocities) {
  const State y = deformed(grid, 3);
  const Vectors whole = evaluate(ode.force, y), elastic = evaluate(ode.force, {y.x, at_rest(y.x)});
  EXPECT_LE(largest(flat(whole - elastic) - Jacobian(ode, y).dv * flat(y.v)), 100 * epsilon * largest(whole));
}

TEST_P(ForcesOf, AreTheSumOfKxAndDvAndTheExplicitForce) {
  const State y = deformed(grid, 4);
  const Vectors Kx = ode.stiffness * y.x, Dv = ode.damping * y.v, rest = evaluate(ode.explicit_force, y);
  const double size = largest(Kx) + largest(Dv) + largest(rest);
  EXPECT_LE(largest(evaluate(ode.force, y) - (Kx + Dv + rest)), 100 * epsilon * size);
}

/// f_expl of a spring is −k w (x_j − x_i)°: it has no scale, so that K x is all that grows with x.
TEST(Forces, OfSpringsAreSplitSuchThatOnlyKxGrows) {
  for (const auto& [name, grid] : grids()) {
    const SplitOde ode = ode_of(force_case("tension"), grid);
    const State y = deformed(grid, 5), doubled{2 * y.x, y.v};
    const Vectors Kx = ode.stiffness * y.x;
    EXPECT_LE(largest(evaluate(ode.force, doubled) - evaluate(ode.force, y) - Kx), 100 * epsilon * largest(Kx)) << name;
    EXPECT_LE(largest(evaluate(ode.explicit_force, doubled) - evaluate(ode.explicit_force, y)), 100 * epsilon * largest(Kx));
  }
}

TEST(Forces, OfSpringsHaveSymmetricNegativeSemidefiniteMatricesWithoutRowSums) {
  for (const auto& [name, grid] : grids()) {
    const SplitOde ode = ode_of(force_case("all_with_a_membrane"), grid);
    for (const Eigen::MatrixXd A : {ode.stiffness, ode.damping}) {
      const double rounding = 100 * epsilon * largest(A);
      EXPECT_EQ(A, A.transpose()) << name;
      EXPECT_LE(largest(A.rowwise().sum()), rounding) << name;
      EXPECT_LE(base::symmetric_eigen(A).values.maxCoeff(), rounding) << name;
    }
  }
}

TEST(Forces, AlongNormalsAreTheProjectionsOfThoseInAllDirections) {
  const Grid grid = five_by_four();
  const State y = deformed(grid, 6);
  const Vectors projected = evaluate(ode_of(force_case("plate"), grid).force, y);
  const Vectors whole = evaluate(ode_of(force_case("unprojected_plate"), grid).force, y);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const auto x = [&](int i, int j) -> Eigen::RowVector3d {
        return y.x.row(grid.index(std::clamp(i, 0, grid.nu - 1), std::clamp(j, 0, grid.nv - 1)));
      };
      const Eigen::RowVector3d N = (x(a + 1, b) - x(a - 1, b)).cross(x(a, b + 1) - x(a, b - 1)).normalized();
      const int i = grid.index(a, b);
      EXPECT_LE(largest(projected.row(i) - whole.row(i).dot(N) * N), 100 * epsilon * largest(whole)) << a << ", " << b;
    }
}

TEST_P(CheckerOf, RejectsAJacobianWithOneWrongEntry) {
  const State y = deformed(grid, 1);
  const Jacobian jacobian(ode, y);
  for (const auto& [numerical, exact] :
       {std::pair{by_positions(ode, y, step), jacobian.dx}, {by_velocities(ode, y, step), jacobian.dv}}) {
    Eigen::MatrixXd wrong = exact;
    for (Eigen::Index k = 0; k < wrong.size(); ++k) {
      const double right = wrong.data()[k];
      if (std::abs(right) <= 1e-5 * largest(numerical)) continue;
      for (const double planted : {1.001 * right, std::numeric_limits<double>::quiet_NaN()}) {
        wrong.data()[k] = planted;
        EXPECT_FALSE(agree(numerical, wrong)) << "entry " << k;
      }
      wrong.data()[k] = right;
    }
  }
}

}  // namespace
}  // namespace drape::verify::forces_test
