// The matrix that Newton's method is given: the exact one where nothing is compressed, positive definite everywhere.

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/small_problems.hpp"
#include "verify/support/threads.hpp"

namespace drape::verify::newton_matrix_test {
namespace {

using namespace small_problems;
using solver::SparseMatrix;

constexpr double gamma = 0.01;

model::Cloth sheet(std::vector<model::Override> changes) {
  changes.insert(changes.begin(), {{"grid.n", "[5, 4]"}});
  return model::compile(model::load_scene("hung-corners", changes));
}

SparseMatrix assembled(const model::Cloth& cloth, const State& y, solver::Jacobian part) {
  SparseMatrix J;
  cloth.ode.newton_matrix(0, y.x, y.v, gamma, part, J);
  return J;
}

Eigen::MatrixXd newton(const model::Cloth& cloth, const State& y, solver::Jacobian part = solver::Jacobian::whole) {
  return Eigen::MatrixXd(SparseMatrix(assembled(cloth, y, part).selfadjointView<Eigen::Upper>()));
}

/// M − γ² ∂f/∂x − γ ∂f/∂v with the rows and columns of pinned coordinates reduced to their mass.
Eigen::MatrixXd exact(const model::Cloth& cloth, const State& y) {
  SparseMatrix dx, dv;
  cloth.ode.jacobian(0, y.x, y.v, dx, dv);
  Eigen::MatrixXd J = -gamma * gamma * Eigen::MatrixXd(dx) - gamma * Eigen::MatrixXd(dv);
  for (const solver::Pin& pin : cloth.ode.pins)
    for (int a = 0; a < 3; ++a)
      if (pin.fixed(a)) J.row(3 * pin.particle + a).setZero(), J.col(3 * pin.particle + a).setZero();
  J.diagonal() += cloth.ode.mass.replicate(1, 3).reshaped<Eigen::RowMajor>();
  return J;
}

State stretched(const model::Cloth& cloth) {
  State y = cloth.start;
  y.x *= 1.2;
  y.v = noise(cloth.ode.particles(), 3);
  return y;
}

State crumpled(const model::Cloth& cloth, double size = 0.3) {
  State y = cloth.start;
  y.x = 0.8 * y.x + size * noise(cloth.ode.particles(), 5);
  y.v = noise(cloth.ode.particles(), 3);
  return y;
}

double relative(const Eigen::MatrixXd& difference, const Eigen::MatrixXd& whole) { return difference.norm() / whole.norm(); }

TEST(NewtonMatrix, IsExactForAStretchedSheet) {
  const model::Cloth cloth = sheet({{"material.damping", "5"}});
  const State y = stretched(cloth);
  EXPECT_LE(relative(newton(cloth, y) - exact(cloth, y), exact(cloth, y)), 1e-14);
}

TEST(NewtonMatrix, IsNotExactForACrumpledOne) {
  const model::Cloth cloth = sheet({{"material.damping", "5"}});
  const State y = crumpled(cloth);
  EXPECT_GE(relative(newton(cloth, y) - exact(cloth, y), exact(cloth, y)), 1e-2);
}

/// Terms that leave out the blocks of other threads, and contraction, which does not.
TEST(NewtonMatrix, IsTheSameForAnyNumberOfThreads) {
  for (const char* form : {"linear", "projected"})
    for (const char* shear_damping : {"0", "1"}) {
      const model::Cloth cloth = sheet({{"grid.n", "[61, 50]"},
                                        {"material.damping", "5"},
                                        {"material.damping_form", form},
                                        {"material.shear", "100"},
                                        {"material.shear_damping", shear_damping},
                                        {"material.contraction", "1e3"}});
      const State y = crumpled(cloth, 0.01);
      for (const solver::Jacobian part : {solver::Jacobian::whole, solver::Jacobian::tension}) {
        const SparseMatrix by_one = assembled(cloth, y, part);
        for (const int threads : {2, 3, 7}) {
          const Threads allowed(threads);
          EXPECT_EQ((assembled(cloth, y, part) - by_one).norm(), 0) << threads << " threads, " << form << " damping";
        }
      }
    }
}

TEST(NewtonMatrix, LeavesOutShearIfOnlyTensionIsWanted) {
  const model::Cloth with = sheet({}), without = sheet({{"material.shear", "0"}});
  const State y = stretched(with);
  EXPECT_EQ((newton(with, y, solver::Jacobian::tension) - newton(without, y)).norm(), 0);
  EXPECT_GT((newton(with, y) - newton(without, y)).norm(), 0);
  SparseMatrix tension, whole;
  with.ode.newton_matrix(0, y.x, y.v, gamma, solver::Jacobian::tension, tension);
  with.ode.newton_matrix(0, y.x, y.v, gamma, solver::Jacobian::whole, whole);
  EXPECT_LT(tension.nonZeros(), whole.nonZeros());
}

class NewtonMatrixOf : public testing::TestWithParam<std::pair<const char*, std::vector<model::Override>>> {};
INSTANTIATE_TEST_SUITE_P(
    , NewtonMatrixOf,
    testing::Values(
        std::pair{"Linear", std::vector<model::Override>{}},
        std::pair{"Projected", std::vector<model::Override>{{"material.damping_form", "projected"}}},
        std::pair{"ViscousShear", std::vector<model::Override>{{"material.shear_damping", "1"}}},
        std::pair{"Contraction", std::vector<model::Override>{{"material.contraction", "1e3"}}},
        std::pair{"Plate", std::vector<model::Override>{{"material.bend", "0.01"}, {"material.bend_damping", "1e-3"}}},
        std::pair{"Unprojected", std::vector<model::Override>{{"material.bend", "0.01"}, {"material.bend_projected", "false"}}},
        std::pair{"Membrane", std::vector<model::Override>{{"material.bend", "1"}, {"material.bend_form", "membrane"}}},
        std::pair{"PrintedShear", std::vector<model::Override>{{"material.shear_form", "printed"}}}),
    [](const auto& test) { return test.param.first; });

TEST_P(NewtonMatrixOf, IsPositiveDefiniteHoweverCrumpledTheSheetIs) {
  const model::Cloth cloth = sheet(GetParam().second);
  const double lightest = cloth.ode.mass.minCoeff();
  for (const double size : {0.0, 0.05, 0.3})
    for (const auto part : {solver::Jacobian::whole, solver::Jacobian::tension}) {
      const Eigen::MatrixXd J = newton(cloth, crumpled(cloth, size), part);
      EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(J).eigenvalues()[0], lightest * (1 - 1e-9)) << size << int(part);
    }
}

TEST_P(NewtonMatrixOf, IsAssembledAnewIntoTheSamePlaces) {
  const model::Cloth cloth = sheet(GetParam().second);
  SparseMatrix J;
  const State first = stretched(cloth), second = crumpled(cloth, 0.05);
  cloth.ode.newton_matrix(0, first.x, first.v, gamma, solver::Jacobian::whole, J);
  cloth.ode.newton_matrix(0, second.x, second.v, 3 * gamma, solver::Jacobian::whole, J);
  SparseMatrix fresh;
  cloth.ode.newton_matrix(0, second.x, second.v, 3 * gamma, solver::Jacobian::whole, fresh);
  EXPECT_EQ((J - fresh).norm(), 0);
}

TEST(NewtonMatrixOfExactJacobian, WouldNotBePositiveDefinite) {
  const model::Cloth cloth = sheet({{"material.tension", "1e6"}, {"material.damping", "0"}});
  State y = crumpled(cloth, 0.001);
  y.x *= 0.5;
  const Eigen::MatrixXd J = exact(cloth, y);
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(J).eigenvalues()[0], 0);
}

}  // namespace
}  // namespace drape::verify::newton_matrix_test
