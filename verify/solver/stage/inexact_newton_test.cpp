// Newton stages whose linear systems conjugate gradients solve: the same solutions as with a factor, for little work.

#include <gtest/gtest.h>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/stage/newton_system.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::inexact_newton_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::LinearResult;
using solver::Outcome;
using solver::SparseMatrix;

constexpr double gamma = 0.01;

model::Cloth sheet(std::vector<model::Override> changes) {
  changes.insert(changes.begin(), {"grid.n", "12"});
  return model::compile(model::load_scene("hung-corners", changes));
}

/// Numerical stiffness 2e5: the springs that are slack resist a hundred thousand times less than the others.
model::Cloth stiff() { return sheet({{"material.tension", "1e7"}, {"material.damping", "0"}}); }

Options newton(const char* linear_solver, double accuracy = 0.1) {
  Options options;
  options.stage_accuracy = accuracy;
  options.stage = &solver::stage_kind("newton");
  options.linear_solver = &solver::linear_solver(linear_solver);
  return options;
}

/// One Newton system in a crumpled sheet, and what two ways make of it.
struct Solved {
  explicit Solved(const model::Cloth& cloth, const char* linear_solver, Options options = {}) : d(cloth.ode.particles(), 3) {
    options.linear_solver = &solver::linear_solver(linear_solver);
    solver::StageSystem system(cloth.ode, options, nullptr);
    solver::NewtonSystem newton(cloth.ode, options, system, solver::Jacobian::whole);
    State y = cloth.start;
    y.x = 0.99 * y.x + 1e-3 * noise(cloth.ode.particles(), 5);
    r.setZero(cloth.ode.particles(), 3);
    cloth.ode.force(0, y.x, y.v, r);
    solver::filter(cloth.ode.pins, r);
    EXPECT_EQ(newton.renew({gamma, 0, y.x, y.v}, y), Outcome::success);
    result = newton.solve(r, d);
    SparseMatrix J;
    cloth.ode.newton_matrix(0, y.x, y.v, gamma, solver::Jacobian::whole, J);
    const Eigen::VectorXd flat_d = d.reshaped<Eigen::RowMajor>(), flat_r = r.reshaped<Eigen::RowMajor>();
    residual = (J.selfadjointView<Eigen::Upper>() * flat_d - flat_r).norm() / flat_r.norm();
  }

  Vectors r = {}, d;
  LinearResult result;
  double residual = 0;  ///< over |r|
};

class InexactNewtonWith : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, InexactNewtonWith, testing::Values("ic0", "mic0", "multigrid"),
                         [](const auto& test) { return test.param; });

TEST_P(InexactNewtonWith, EndsAtTheForcingTermAndNoLater) {
  const model::Cloth cloth = sheet({{"material.tension", "1e5"}, {"material.damping", "0.5"}});
  const Solved solved(cloth, GetParam().c_str());
  EXPECT_EQ(solved.result.outcome, Outcome::success);
  EXPECT_LE(solved.residual, 0.1);
  EXPECT_GE(solved.residual, 1e-3);
  EXPECT_LE(solved.result.iterations, 30);
  EXPECT_EQ(cloth.ode.work->count("cg_iterations"), solved.result.iterations);
  EXPECT_EQ(cloth.ode.work->count("matrix_products"), solved.result.iterations);
  EXPECT_EQ(cloth.ode.work->count("preconditioner_applications"), solved.result.iterations);
}

TEST_P(InexactNewtonWith, GivesUpdatesWhoseSizeIsThatOfTheFactors) {
  const model::Cloth cloth = stiff();
  const Solved exact(cloth, "cholesky"), ours(cloth, GetParam().c_str());
  EXPECT_LE(exact.residual, 1e-9);
  EXPECT_NEAR(ours.d.norm(), exact.d.norm(), 0.15 * exact.d.norm());
  EXPECT_LE((ours.d - exact.d).norm(), 0.6 * exact.d.norm());
}

TEST_P(InexactNewtonWith, SolvesStiffUndampedStagesAsAFactorDoes) {
  const auto run = [](const model::Cloth& cloth, const char* linear_solver) {
    Integrator integrator(cloth.ode, solver::method("bdf2"), newton(linear_solver, 1e-4), cloth.start);
    const solver::RunResult result = integrate(integrator, 0.05, 0.01);
    EXPECT_EQ(result.outcome, Outcome::success) << result.message;
    EXPECT_EQ(result.rejected_steps, 0);
    return integrator.state().x;
  };
  const model::Cloth factored = stiff(), iterated = stiff();
  const Vectors exact = run(factored, "cholesky"), ours = run(iterated, GetParam().c_str());
  EXPECT_LE(largest(ours - exact), 1e-6);
  const auto count = [&](const char* kind) { return iterated.ode.work->count(kind); };
  EXPECT_EQ(count("newton_factorisations"), 0);
  EXPECT_LE(count("newton_matrices"), 1.5 * factored.ode.work->count("newton_matrices"));
  EXPECT_GE(count("cg_iterations"), 5 * count("updates"));
  EXPECT_LE(count("cg_iterations"), 150 * count("updates"));
  EXPECT_EQ(factored.ode.work->count("cg_iterations"), 0);
  EXPECT_EQ(factored.ode.work->count("newton_factorisations"), factored.ode.work->count("newton_matrices"));
}

TEST(InexactNewton, DoesNotPassOnWhatDidNotConverge) {
  Options options;
  options.max_cg_iterations = 2;
  EXPECT_EQ(Solved(stiff(), "ic0", options).result.outcome, Outcome::not_converged);
}

TEST(InexactNewton, TakesThePlaceOfTheFactorOnLargeSheets) {
  for (const bool large : {false, true}) {
    const model::Override size[] = {{"grid.n", large ? "[51, 50]" : "[50, 50]"}};
    const model::Cloth cloth = model::compile(model::load_scene("hung-corners", size));
    Integrator integrator(cloth.ode, solver::method("implicit-euler"), newton("auto"), cloth.start);
    EXPECT_EQ(integrator.step(1e-3).outcome, Outcome::success);
    EXPECT_EQ(cloth.ode.work->count("newton_factorisations") > 0, !large);
    EXPECT_EQ(cloth.ode.work->count("cg_iterations") > 0, large);
  }
}

}  // namespace
}  // namespace drape::verify::inexact_newton_test
