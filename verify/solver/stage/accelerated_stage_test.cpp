// Stages that Anderson's method solves, with the constant matrix and with Newton's, and the steps around them.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::accelerated_stage_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Outcome;
using solver::RunResult;

model::Cloth sheet(std::vector<model::Override> changes = {}) {
  changes.insert(changes.begin(), {"grid.n", "8"});
  return model::compile(model::load_scene("hung-corners", changes));
}

/// Stiff and hardly damped: the fixed-point loop does not converge in any reasonable time.
model::Cloth stiff() { return sheet({{"material.tension", "1e7"}, {"material.damping", "0.5"}}); }

/// `name`: of a stage solver, and after a slash of a linear solver.
Options stage(const std::string& name, double accuracy = 0.1) {
  Options options;
  const std::size_t slash = name.find('/');
  options.stage = &solver::stage_kind(name.substr(0, slash));
  if (slash != std::string::npos) options.linear_solver = &solver::linear_solver(name.substr(slash + 1));
  options.stage_accuracy = accuracy;
  return options;
}

struct Ended {
  RunResult result;
  State end;
};

Ended run(const model::Cloth& cloth, const char* method, const Options& options, double h, double until = 0.1) {
  Integrator integrator(cloth.ode, solver::method(method), options, cloth.start);
  const RunResult result = integrate(integrator, until, h);
  return {result, integrator.state()};
}

double rms(const Vectors& difference) { return difference.norm() / std::sqrt(difference.rows()); }

TEST(AcceleratedStages, ServeTheNextOnes) {
  const model::Cloth cloth = sheet({{"material.damping", "50"}});
  Integrator integrator(cloth.ode, solver::method("bdf2"), stage("anderson"), cloth.start);
  std::vector<int> updates;
  integrate(integrator, 1, 0.01, [&](const solver::StepReport& step) { updates.push_back(step.updates); });
  ASSERT_EQ(updates.size(), 100U);
  EXPECT_LE(std::accumulate(updates.begin() + 80, updates.end(), 0), 30);  // of 20 steps
}

/// Folds that tumble: what one update reduces the error by says little of the next.
TEST(AcceleratedStages, CountOnNoReductionsWhereConvergenceIsIrregular) {
  DRAPE_SLOW();
  const model::Scene scene = model::load_scene("wind");
  const model::Cloth cloth = model::compile(scene);
  const Ended usual = run(cloth, "esdirk4", stage("auto"), 0.01, 0.5),
              exact = run(cloth, "esdirk4", stage("auto", 1e-3), 0.01, 0.5);
  ASSERT_EQ(usual.result.outcome, Outcome::success) << usual.result.message;
  ASSERT_EQ(exact.result.outcome, Outcome::success) << exact.result.message;
  EXPECT_LE(rms(usual.end.x - exact.end.x), 2e-5 * model::size(scene)) << "the error of the time step is 1.7e-5";
}

class StageKinds : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, StageKinds,
                         testing::Values("anderson", "newton", "tension-newton", "auto", "newton/multigrid",
                                         "tension-newton/ic0"),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(StageKinds, SolveTheSameEquationAsTheFixedPointLoop) {
  DRAPE_SLOW();
  const model::Cloth cloth = sheet({{"material.damping", "5"}});
  for (const char* method : {"implicit-euler", "bdf2", "midpoint", "tr-bdf2", "esdirk4", "bdf4"}) {
    const Ended exact = run(cloth, method, tight(), 0.01);
    ASSERT_EQ(exact.result.outcome, Outcome::success) << method << ": " << exact.result.message;
    const Ended ours = run(cloth, method, stage(GetParam(), 1e-8), 0.01);
    ASSERT_EQ(ours.result.outcome, Outcome::success) << method << ": " << ours.result.message;
    EXPECT_LE(rms(ours.end.x - exact.end.x), 1e-9) << method;
    EXPECT_LE(rms(ours.end.v - exact.end.v), 1e-7) << method;
  }
}

TEST_P(StageKinds, LeaveAPartOfTheErrorOfTheTimeStep) {
  DRAPE_SLOW();
  const model::Cloth cloth = sheet({{"material.damping", "5"}});
  const Vectors truth = run(cloth, "bdf2", stage("auto", 1e-6), 1e-4).end.x;
  for (const double h : {0.01, 0.005, 0.0025}) {
    const Vectors exact = run(cloth, "bdf2", tight(), h).end.x;
    const Vectors ours = run(cloth, "bdf2", stage(GetParam()), h).end.x;
    EXPECT_LE(rms(ours - exact), 0.3 * rms(exact - truth)) << h;
  }
}

TEST_P(StageKinds, WorkWithPartialPinsAndObstacles) {
  DRAPE_SLOW_IF(GetParam() != "newton" && GetParam() != "auto");
  for (const char* scene : {"pulled", "box_swing"}) {
    const model::Override small[] = {{"grid.n", "6"}};
    const model::Cloth cloth = model::compile(model::load_scene(scene, small));
    const Ended exact = run(cloth, "bdf2", tolerances(1e-11, 1e-12), 0.002, 0.02);
    const Ended ours = run(cloth, "bdf2", stage(GetParam(), 1e-6), 0.002, 0.02);
    ASSERT_EQ(ours.result.outcome, Outcome::success) << ours.result.message;
    EXPECT_LE(rms(ours.end.x - exact.end.x), 1e-8) << scene;
  }
}

TEST(FixedPoint, DoesNotConvergeOnAStiffSheet) {
  Options options = solver::thesis_options();
  options.max_updates = 1000;
  EXPECT_EQ(run(stiff(), "bdf2", options, 0.01).result.outcome, Outcome::not_converged);
}

TEST(Auto, EscalatesOnAStiffSheetOnly) {
  const model::Cloth soft = sheet(), hard = stiff();
  EXPECT_EQ(run(soft, "bdf2", {}, 0.01).result.outcome, Outcome::success);
  EXPECT_EQ(soft.ode.work->count("escalations"), 0);
  EXPECT_EQ(soft.ode.work->count("newton_matrices"), 0);
  EXPECT_EQ(soft.ode.work->count("newton_factorisations"), 0);
  EXPECT_EQ(run(hard, "bdf2", {}, 0.01).result.outcome, Outcome::success);
  EXPECT_GE(hard.ode.work->count("escalations"), 1);
  EXPECT_GE(hard.ode.work->count("newton_matrices"), 1);
}

TEST(Auto, IsAsAccurateAsNewtonOnAStiffSheet) {
  const Vectors truth = run(stiff(), "bdf2", stage("newton", 1e-6), 0.01).end.x;
  const Ended ours = run(stiff(), "bdf2", {}, 0.01);
  EXPECT_LE(rms(ours.end.x - truth), 8e-6);  // a tenth of the error of the time step
  EXPECT_LE(ours.result.rejected_steps, 2);
}

/// Without damping, numerical stiffness 1e7: folds as soon as it hangs.
model::Cloth inextensible() { return sheet({{"material.tension", "1e9"}, {"material.damping", "0"}}); }

TEST(NewtonSearch, SolvesWhatNothingElseDoesWithoutCuttingSteps) {
  for (const char* method : {"implicit-euler", "bdf2", "midpoint"}) {
    const model::Cloth cloth = inextensible();
    const Ended ours = run(cloth, method, {}, 0.01, 0.25);
    ASSERT_EQ(ours.result.outcome, Outcome::success) << method << ": " << ours.result.message;
    EXPECT_EQ(ours.result.rejected_steps, 0) << method;
    EXPECT_GE(cloth.ode.work->count("searched_stages"), 10) << method;
    EXPECT_LE(cloth.ode.work->count("newton_factorisations"), 500) << method;
  }
}

TEST(Auto, DoesNotTrustAConstantMatrixThatIsFarTooStiff) {
  const Vectors exact = run(inextensible(), "implicit-euler", stage("newton", 1e-7), 0.01).end.x;
  for (const char* kind : {"auto", "newton", "tension-newton"})
    EXPECT_LE(rms(run(inextensible(), "implicit-euler", stage(kind), 0.01).end.x - exact), 1e-4) << kind;
}

TEST(NewtonSearch, IsNotNeededWhereDampingIsStrong) {
  const model::Cloth cloth = sheet({{"material.tension", "1e9"}, {"material.damping", "1e6"}});
  EXPECT_EQ(run(cloth, "bdf2", {}, 0.01).result.outcome, Outcome::success);
  EXPECT_EQ(cloth.ode.work->count("searched_stages"), 0);
}

TEST(Anderson, NeedsFarFewerUpdatesThanTheLoopItAccelerates) {
  const model::Cloth loop = sheet({{"material.damping", "5"}}), accelerated = sheet({{"material.damping", "5"}});
  run(loop, "bdf2", tolerances(1e-6, 1e-7), 0.01);
  run(accelerated, "bdf2", stage("anderson"), 0.01);
  EXPECT_LE(4 * accelerated.ode.work->count("updates"), loop.ode.work->count("updates"));
}

TEST(Newton, KeepsItsFactorWhileItConverges) {
  const model::Cloth cloth = sheet();
  const Ended lagged = run(cloth, "bdf2", stage("newton"), 0.005);
  EXPECT_EQ(lagged.result.outcome, Outcome::success);
  EXPECT_LE(5 * cloth.ode.work->count("newton_factorisations"), lagged.result.steps);
  EXPECT_GE(cloth.ode.work->count("newton_factorisations"), 1);
}

TEST(Newton, LeavesTheConstantMatrixAlone) {
  for (const char* kind : {"newton", "tension-newton"}) {
    const model::Cloth cloth = sheet();
    EXPECT_EQ(run(cloth, "bdf2", stage(kind), 0.005).result.outcome, Outcome::success);
    EXPECT_EQ(cloth.ode.work->count("matrix_builds"), 0) << kind;
    EXPECT_EQ(cloth.ode.work->count("factorisations"), 0) << kind;
  }
}

TEST(Newton, NeedsAMatrix) {
  model::Cloth cloth = sheet();
  cloth.ode.newton_matrix = nullptr;
  EXPECT_THROW(run(cloth, "bdf2", stage("newton"), 0.01), std::invalid_argument);
  EXPECT_EQ(run(cloth, "bdf2", stage("auto"), 0.01).result.outcome, Outcome::success);
}

TEST(Steps, ThatDoNotConvergeAreCutAndNotPassedOn) {
  model::Cloth cloth = sheet();
  Options options = stage("anderson");
  options.max_updates = 4;
  Integrator integrator(cloth.ode, solver::method("bdf2"), options, cloth.start);
  std::vector<double> sizes;
  const RunResult result = integrate(integrator, 0.1, 0.05, [&](const solver::StepReport& s) { sizes.push_back(s.h); });
  EXPECT_EQ(result.outcome, Outcome::success) << result.message;
  EXPECT_GE(result.rejected_steps, 1);
  EXPECT_LT(*std::ranges::min_element(sizes), 0.05);
  EXPECT_NEAR(std::accumulate(sizes.begin(), sizes.end(), 0.0), 0.1, 1e-12);
  EXPECT_LE(rms(integrator.state().x - run(sheet(), "bdf2", tight(), 1e-3).end.x), 1e-3);
}

Options within(double tolerance) {
  Options options;
  options.error_control = {.tolerance = tolerance, .length = 1.1, .duration = 0.3};
  return options;
}

class ErrorControlOf : public testing::TestWithParam<std::string> {
 protected:
  const model::Cloth cloth = sheet({{"material.damping", "5"}});
  const Vectors truth = run(cloth, "midpoint", tight(), 2.5e-4, 0.3).end.x;

  double error(double tolerance) {
    const Ended ours = run(cloth, GetParam().c_str(), within(tolerance), 0.1, 0.3);
    EXPECT_EQ(ours.result.outcome, Outcome::success) << ours.result.message;
    return rms(ours.end.x - truth) / 1.1;
  }
};
INSTANTIATE_TEST_SUITE_P(, ErrorControlOf,
                         testing::Values("implicit-euler", "sbdf2", "bdf2", "midpoint", "tr-bdf2", "esdirk3", "esdirk4", "bdf3",
                                         "verlet"),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(ErrorControlOf, FollowsTheTolerance) {
  for (const double tolerance : {1e-3, 1e-4}) EXPECT_LE(error(tolerance), 30 * tolerance) << tolerance;
}

TEST_P(ErrorControlOf, TakesMoreStepsForLess) {
  DRAPE_SLOW();
  const auto steps = [&](double tolerance) { return run(cloth, GetParam().c_str(), within(tolerance), 0.1, 0.3).result.steps; };
  const int coarse = steps(1e-3), fine = steps(1e-5);
  EXPECT_GE(fine, GetParam() == "verlet" ? coarse : 1.5 * coarse);  // stability keeps verlet accurate
}

TEST_P(ErrorControlOf, EndsAtTheEnd) {
  DRAPE_SLOW();
  Integrator integrator(cloth.ode, solver::method(GetParam()), within(1e-3), cloth.start);
  EXPECT_EQ(integrate(integrator, 0.2345, 0.1).outcome, Outcome::success);
  EXPECT_NEAR(integrator.time(), 0.2345, 1e-9);
}

TEST(ErrorControl, SeesTheLagOfTheExplicitPart) {
  const model::Cloth cloth = sheet({{"material.damping", "0.5"}});
  const Vectors truth = run(cloth, "verlet", {}, 1e-3, 0.3).end.x;
  const Ended constant = run(cloth, "sbdf2", {}, 0.01, 0.3), controlled = run(cloth, "sbdf2", within(1e-3), 0.1, 0.3);
  EXPECT_GE(rms(constant.end.x - truth), 0.02) << "stable and wrong";
  EXPECT_LE(3 * rms(controlled.end.x - truth), rms(constant.end.x - truth));
}

TEST(ErrorControl, RejectsSteps) {
  model::Cloth cloth = sheet();
  cloth.ode.force = [force = cloth.ode.force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
    force(t, x, v, f);
    if (t > 0.2) f.col(1).array() += 0.1;  // a gust
  };
  const Ended ours = run(cloth, "bdf2", within(1e-5), 0.1, 0.3);
  EXPECT_EQ(ours.result.outcome, Outcome::success);
  EXPECT_GE(ours.result.rejected_steps, 1);
}

}  // namespace
}  // namespace drape::verify::accelerated_stage_test
