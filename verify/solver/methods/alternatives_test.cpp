// The methods that section 3.2 of the thesis tells of: what each of them is in closed form, and what it cannot do.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/distance.hpp"
#include "solver/methods/desbrun.hpp"
#include "solver/methods/strain_limited.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::alternatives_test {
namespace {

using namespace small_problems;
using solver::CompliantConstraint;
using solver::Integrator;
using solver::LinearisedSystem;
using solver::Outcome;

/// A sheet without pins.
model::Cloth free_sheet(int n, double gravity = 0, double damping = 0) {
  model::Scene scene;
  scene.sheet.grid = {n, n, 0.5, 0.5};
  scene.sheet.material.density = 0.2;
  scene.sheet.material.tension = {1000, 1000};
  scene.sheet.material.shear = 10;
  scene.sheet.material.damping = {damping, damping};
  scene.sheet.gravity = {0, 0, -gravity};
  return model::compile(scene);
}

model::Cloth hung_sheet(const std::vector<model::Override>& more = {}) {
  std::vector<model::Override> overrides{{"grid.n", "6"}, {"material.damping", "5"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return model::compile(model::load_scene("hung-edge", overrides));
}

State after(const SplitOde& ode, const Method& method, const Options& options, const State& start, int steps, double h) {
  Integrator integrator(ode, method, options, start);
  for (int k = 0; k < steps; ++k) EXPECT_EQ(integrator.step(h).outcome, Outcome::success) << method.name << ", step " << k;
  return integrator.state();
}
State after(const SplitOde& ode, std::string_view method, const Options& options, const State& start, int steps, double h) {
  return after(ode, solver::method(method), options, start, steps, h);
}

// --- Baraff and Witkin ----------------------------------------------------------------------------------------------------

TEST(BaraffWitkinCg, IsTheFactoredOneUpToItsTolerance) {
  const model::Cloth cloth = hung_sheet();
  const State factored = after(cloth.ode, "baraff-witkin", {}, cloth.start, 20, 0.01);
  Options options;
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    options.cg_tolerance = tolerance;
    const double off = distance(after(cloth.ode, "baraff-witkin-cg", options, cloth.start, 20, 0.01), factored);
    EXPECT_LE(off, 10 * tolerance);
    EXPECT_GE(off, 1e-4 * tolerance) << "or it is not by conjugate gradients";
  }
}

TEST(BaraffWitkinCg, CountsItsIterations) {
  const model::Cloth cloth = hung_sheet();
  Integrator integrator(cloth.ode, solver::method("baraff-witkin-cg"), {}, cloth.start);
  const auto result = integrator.step(0.01);
  EXPECT_GE(result.cg_iterations, 5);
  EXPECT_EQ(cloth.ode.work->count("cg_iterations"), result.cg_iterations);
  EXPECT_EQ(cloth.ode.work->count("preconditioner_applications"), result.cg_iterations);
  EXPECT_EQ(cloth.ode.work->count("klu_analyses"), 0);
}

TEST(BaraffWitkinCg, SolvesWithTheSymmetricPartOfUnsymmetricJacobians) {
  Problem problem = partly_pinned();
  problem.ode.jacobian = [original = problem.ode.jacobian](double t, const Vectors& x, const Vectors& v, SparseMatrix& df_dx,
                                                           SparseMatrix& df_dv) {
    original(t, x, v, df_dx, df_dv);
    df_dx.coeffRef(0, 7) += 3;
    df_dx.coeffRef(7, 0) -= 3;
    df_dx.makeCompressed();
  };
  const State y = problem.start;
  const Vectors r = noise(particles, 3);
  Vectors d, symmetric;
  LinearisedSystem system(problem.ode);
  ASSERT_EQ(system.assemble(0.1, start_time, y), Outcome::success);
  EXPECT_EQ(system.solve_symmetric(r, 1e-14, 100, d).outcome, Outcome::success);
  const Problem without = partly_pinned();
  LinearisedSystem symmetric_system(without.ode);
  ASSERT_EQ(symmetric_system.factor(0.1, start_time, y), Outcome::success);
  symmetric_system.solve(r, symmetric);
  EXPECT_LE(largest(d - symmetric), 1e-12);
  EXPECT_EQ(system.solve_symmetric(r, 1e-14, 2, d).outcome, Outcome::not_converged);
}

// --- Desbrun --------------------------------------------------------------------------------------------------------------

TEST(Desbrun, IsImexEulerBeforeItsCorrection) {
  Method uncorrected = solver::method("desbrun");
  uncorrected.step = solver::desbrun_without_correction;
  for (const Problem& p : problems())
    EXPECT_LE(
        distance(after(p.ode, uncorrected, tight(), p.start, 20, 0.05), after(p.ode, "imex-euler", tight(), p.start, 20, 0.05)),
        1e-12)
        << p.name;
}

Eigen::Vector3d angular_momentum(const SplitOde& ode, const State& y) {
  return reference::angular_momentum(ode.mass, Eigen::RowVector3d::Zero(), y);
}

/// A free sheet that turns about a slanted axis, and flies.
State spinning(const model::Cloth& cloth) {
  State y = cloth.start;
  const Eigen::RowVector3d omega(1, 2, 5), flight(0.3, -0.2, 0.1);
  for (int i = 0; i < y.x.rows(); ++i) y.v.row(i) = flight + omega.cross(y.x.row(i));
  return y;
}

TEST(Desbrun, KeepsTheAngularMomentumThatImexMethodsLose) {
  const model::Cloth cloth = free_sheet(6);
  const State start = spinning(cloth);
  const Eigen::Vector3d before = angular_momentum(cloth.ode, start);
  const auto lost = [&](std::string_view method) {
    const State end = after(cloth.ode, method, tight(), start, 10, 0.01);
    return (angular_momentum(cloth.ode, end) - before).norm() / before.norm();
  };
  EXPECT_LE(lost("desbrun"), 1e-12);
  EXPECT_GE(lost("imex-euler"), 0.1);
  EXPECT_GE(lost("sbdf2"), 0.01);
}

TEST(Desbrun, LetsWeightAndDampingTurnASheet) {
  const model::Cloth cloth = free_sheet(5, 9.81, 0.5);
  const State start = spinning(cloth);
  const double h = 0.01;
  Method uncorrected = solver::method("desbrun");
  uncorrected.step = solver::desbrun_without_correction;
  const State end = after(cloth.ode, "desbrun", tight(), start, 1, h),
              plain = after(cloth.ode, uncorrected, tight(), start, 1, h);
  const Vectors drag = cloth.ode.damping * plain.v;  // by which the system was solved
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (int i = 0; i < cloth.ode.particles(); ++i)
    torque += Eigen::Vector3d(start.x.row(i))
                  .cross(Eigen::Vector3d(drag.row(i)) - 9.81 * cloth.ode.mass[i] * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d gained = angular_momentum(cloth.ode, end) - angular_momentum(cloth.ode, start);
  EXPECT_LE((gained - h * torque).norm(), 1e-12);
  EXPECT_GE(gained.norm(), 1e-4);
}

TEST(Desbrun, RefusesInversesThatFillTheMemory) {
  const model::Cloth cloth = hung_sheet({{"grid.n", "80"}});
  Integrator integrator(cloth.ode, solver::method("desbrun"), {}, cloth.start);
  EXPECT_EQ(integrator.step(0.01).outcome, Outcome::out_of_memory);
}

// --- Kang -----------------------------------------------------------------------------------------------------------------

constexpr double numerical_stiffness = 1000 * 0.01 * 0.01 / (0.2 * 0.1 * 0.1);  // h² k/(ρ l²) of free_sheet(6), h = 0.01

TEST(Kang, LetsAFallingSheetHangInTheAir) {
  const model::Cloth cloth = free_sheet(6, 9.81);
  State start = cloth.start;
  start.v.rowwise() = Eigen::RowVector3d(0.3, 0, -1);
  const State end = after(cloth.ode, "kang", {}, start, 1, 0.01);
  const Eigen::RowVector3d should = Eigen::RowVector3d(0.3, 0, -1 - 0.0981) / (1 + 4 * numerical_stiffness);
  for (int b = 1; b < 5; ++b)
    for (int a = 1; a < 5; ++a) EXPECT_LE((end.v.row(a + 6 * b) - should).norm(), 1e-13);
}

TEST(Kang, LeadsToImexEulerByMoreSweeps) {
  const model::Cloth cloth = free_sheet(6, 9.81);
  const State start = spinning(cloth), exact = after(cloth.ode, "imex-euler", tight(), start, 1, 0.01);
  const double rate = 4 * numerical_stiffness / (1 + 4 * numerical_stiffness);
  Options options;
  const auto off = [&](int sweeps) {
    options.sweeps = sweeps;
    const Vectors error = after(cloth.ode, "kang", options, start, 1, 0.01).v - exact.v;
    return largest(error);
  };
  double before = off(1);
  for (int sweeps = 2; sweeps <= 256; sweeps *= 2) {
    const double now = off(sweeps);
    EXPECT_LE(now, 1.0001 * std::pow(rate, sweeps / 2) * before) << sweeps;
    before = now;
  }
  EXPECT_LE(off(30'000), 1e-9);
}

TEST(Kang, SlowsTheFlightOfADampedSheetHoweverShortTheSteps) {
  const model::Cloth cloth = free_sheet(5, 0, 1);
  State start = cloth.start;
  start.v.setOnes();
  for (const int steps : {100, 1000, 10'000}) {
    EXPECT_LE(largest(after(cloth.ode, "kang", {}, start, steps, 0.05 / steps).v), 0.1) << steps;
  }
  EXPECT_FALSE(solver::method("kang").converges);
}

// --- Strain limiting ------------------------------------------------------------------------------------------------------

TEST(StrainLimiting, CutsASpringByItsInverseMasses) {
  Vectors x = Vectors::Zero(2, 3), weights(2, 3);
  x(1, 0) = 1.5;
  weights.row(0).setConstant(1);
  weights.row(1).setConstant(3);
  const std::vector<CompliantConstraint> spring{{CompliantConstraint::Kind::distance, {0, 1, 1}, 1, 1}};
  EXPECT_TRUE(solver::limit_strain(spring, weights, solver::ObliquePins(std::vector<Pin>()), x));
  EXPECT_NEAR(x(0, 0), 0.1, 1e-15);
  EXPECT_NEAR(x(1, 0), 1.2, 1e-15);
  x(1, 0) = 1.19;
  EXPECT_FALSE(solver::limit_strain(spring, weights, solver::ObliquePins(std::vector<Pin>()), x));
}

TEST(StrainLimiting, MovesPinnedParticlesAcrossTheirPins) {
  const Eigen::Vector3d held = Eigen::Vector3d(3, 0, 4) / 5;
  const std::vector<Pin> pins{{.particle = 1, .held = held * held.transpose()}};
  Vectors x = Vectors::Zero(2, 3), weights = Vectors::Ones(2, 3);
  x(1, 0) = 1.5;
  const double along = x.row(1).dot(held);
  const std::vector<CompliantConstraint> spring{{CompliantConstraint::Kind::distance, {0, 1, 1}, 1, 1}};
  EXPECT_TRUE(solver::limit_strain(spring, weights, solver::ObliquePins(pins), x));
  EXPECT_NEAR(x.row(1).dot(held), along, 1e-15);
  EXPECT_LT(x.row(1).norm(), 1.45);
  EXPECT_GT(x(0, 0), 0.2);
}

/// A hung sheet, pulled to one and a half of its size, that has been cut by this number of sweeps in an order.
Vectors cut(const model::Cloth& cloth, unsigned order, int sweeps) {
  auto constraints = cloth.ode.compliant_constraints();
  std::shuffle(constraints.begin(), constraints.end(), std::mt19937(order));
  Vectors x = 1.5 * cloth.start.x, weights = Vectors::Zero(x.rows(), 3);
  for (int c = 0; c < 3; ++c) weights.col(c) = cloth.ode.mass.cwiseInverse();
  filter(cloth.ode.pins, weights);
  for (const Pin& pin : cloth.ode.pins) x.row(pin.particle) = cloth.start.x.row(pin.particle);
  for (int k = 0; k < sweeps; ++k) solver::limit_strain(constraints, weights, solver::ObliquePins(cloth.ode.pins), x);
  return x;
}

/// How far apart ten orders are on the average, over the size.
double spread(const model::Cloth& cloth, int sweeps) {
  std::vector<Vectors> all;
  for (unsigned order = 0; order < 10; ++order) all.push_back(cut(cloth, order, sweeps));
  const Vectors mean = std::accumulate(all.begin() + 1, all.end(), all.front()) / 10;
  double sum = 0;
  for (const Vectors& x : all) sum += (x - mean).squaredNorm() / 10;
  return std::sqrt(sum / static_cast<double>(mean.rows())) / 0.8;
}

TEST(StrainLimiting, DependsOnTheOrderOfSpringsHoweverOftenItIsRepeated) {
  const model::Cloth cloth = hung_sheet();
  EXPECT_GE(spread(cloth, 1), 1e-2);
  EXPECT_GE(spread(cloth, 1), 1.2 * spread(cloth, 100));
  EXPECT_GE(spread(cloth, 100), 1e-3);
}

TEST(StrainLimited, KeepsTheMomentumOfFreeSheets) {
  const model::Cloth cloth = free_sheet(5);
  State start = spinning(cloth);
  start.x *= 1.3;
  const State end = after(cloth.ode, "strain-limited", {}, start, 10, 0.01);
  const auto momentum = [&](const State& y) { return Eigen::RowVector3d(cloth.ode.mass.transpose() * y.v); };
  EXPECT_LE((momentum(end) - momentum(start)).norm(), 1e-13);
  EXPECT_GE(largest(end.v - start.v), 0.1);
}

/// It hangs lower than the sheet does by nearly a tenth, not by a strain of ρ g l²/k.
TEST(StrainLimited, HangsInItsLimitInsteadOfItsSprings) {
  const model::Cloth cloth = hung_sheet({{"material.tension", "100"}, {"material.damping", "0.5"}});
  const State end = after(cloth.ode, "strain-limited", {}, cloth.start, 200, 0.01);
  double longest = 0;
  for (const CompliantConstraint& c : cloth.ode.compliant_constraints())
    if (c.kind == CompliantConstraint::Kind::distance)
      longest = std::max(longest, (end.x.row(c.particles[1]) - end.x.row(c.particles[0])).norm() / c.rest - 1);
  EXPECT_GE(longest, 0.09);
  EXPECT_LE(longest, 0.15) << "one sweep does not cut all";
}

}  // namespace
}  // namespace drape::verify::alternatives_test
