// Wind and the resistance of the air: what a flat sheet takes of them, when, and how integrators follow.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference/sundials/cvode.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/model_fixtures.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::wind_test {
namespace {

using namespace sheets;
using Eigen::Vector3d;
using model::Wind;
using small_problems::identifier;
using small_problems::names;
using small_problems::tight;
using solver::Integrator;
using solver::Outcome;

constexpr double rounding = 1e-13;

SplitOde blown(const Wind& wind, const Grid& grid = five_by_four()) {
  Scene scene;
  scene.sheet = {.grid = grid, .material = {}, .wind = wind};
  return compile(scene).ode;
}

SplitOde in_air(double c) {
  Scene scene;
  scene.sheet = {.grid = five_by_four(), .material = {}, .air = c};
  return compile(scene).ode;
}

Vectors force_at(const SplitOde& ode, double t, const State& y) {
  Vectors f;
  ode.force(t, y.x, y.v, f);
  return f;
}

/// A sheet at rest whose normal is e_z.
State flat() { return {five_by_four().parameters(), at_rest(five_by_four().parameters())}; }

/// The force on a whole flat sheet over its area, 0.6 m².
Vector3d load(const Wind& wind, double t = 0) { return force_at(blown(wind), t, flat()).colwise().sum().transpose() / 0.6; }

testing::AssertionResult equal(const Vector3d& a, const Vector3d& b) {
  return testing::AssertionResult((a - b).norm() <= rounding * b.norm()) << a.transpose() << " and " << b.transpose();
}

TEST(Wind, AcrossASheetActsByItsDragAndAlongItByItsLift) {
  const double a = 1.7, drag = 0.8, lift = 0.3;
  const auto from = [&](const Vector3d& w) { return load({.load = w, .constant = a, .drag = drag, .lift = lift}); };
  EXPECT_TRUE(equal(from({0, 0, 5}), {0, 0, drag * a * 5}));
  EXPECT_TRUE(equal(from({0, 0, -5}), {0, 0, -drag * a * 5}));
  EXPECT_TRUE(equal(from({3, 4, 0}), {lift * a * 3, lift * a * 4, 0}));
  EXPECT_TRUE(equal(from({5, 0, 5}), {lift * a * 5, 0, drag * a * 5}));
}

TEST(Wind, ActsOnEveryParticleByItsArea) {
  const Vectors f = force_at(blown({.load = {0, 0, 2}}), 0, flat());
  EXPECT_LE(largest(f.col(2) - 2 * five_by_four().cell_areas()), rounding);
}

TEST(Wind, OscillatesInTime) {
  const Wind wind{.load = {0, 0, 2}, .constant = 0.4, .frequency = 3};
  for (const double t : {0.0, 0.1, std::numbers::pi / 6, 1.3})
    EXPECT_TRUE(equal(load(wind, t), {0, 0, 2 * (0.4 + std::sin(3 * t))})) << t;
}

TEST(Wind, HasAJacobianThatOscillatesWithIt) {
  const SplitOde ode = blown({.load = {1, -1, 2}, .constant = 0.4, .frequency = 3});
  const State y = deformed(five_by_four(), 1);
  SparseMatrix then, now, dv;
  ode.jacobian(0, y.x, y.v, then, dv);
  ode.jacobian(0.7, y.x, y.v, now, dv);
  EXPECT_LE(largest(now - (0.4 + std::sin(2.1)) / 0.4 * then), rounding * largest(now));
}

TEST(Wind, ThatSurfacesTakeUndividedNeedsNoNormalsAndExistsOnChains) {
  const Wind wind{.load = {1, 2, 3}, .drag = 0.7, .lift = 0.7};
  const Grid chain{6, 1, 1, 0.25};
  const SplitOde ode = blown(wind, chain);
  const State y = deformed(chain, 1);
  EXPECT_LE(largest(force_at(ode, 0, y) - 0.7 * chain.cell_areas() * wind.load.transpose()), rounding);
  EXPECT_EQ(ode.work->counter("normals", ""), 0);
}

TEST(Wind, DoesNotExistWithoutLoadOrStrengthOrResponse) {
  for (const Wind& wind : {Wind{}, Wind{.load = {0, 0, 1}, .constant = 0}, Wind{.load = {0, 0, 1}, .drag = 0}}) {
    Scene scene;
    scene.sheet.wind = wind;
    EXPECT_TRUE(compile(scene).plan.terms.empty());
    EXPECT_FALSE(compile(scene).plan.normals);
  }
}

// --- Air -----------------------------------------------------------------------------------------------------------------

TEST(Air, ResistsByTheVelocityAcrossTheSheetAgainstTheMotion) {
  State y = flat();
  for (const Vector3d& v : {Vector3d(0, 0, 2), {0, 0, -2}, {3, 0, 4}, {3, 0, -4}}) {
    y.v.rowwise() = v.transpose();
    const Vector3d density = force_at(in_air(0.5), 0, y).colwise().sum() / 0.6;
    EXPECT_TRUE(equal(density, -0.5 * std::abs(v[2]) * v.normalized())) << v.transpose();
  }
}

TEST(Air, DoesNotResistRestNorMotionAlongTheSheet) {
  State y = flat();
  EXPECT_EQ(force_at(in_air(1), 0, y), y.v);
  y.v.rowwise() = Eigen::RowVector3d(1, 2, 0);
  EXPECT_EQ(largest(force_at(in_air(1), 0, y)), 0);
}

TEST(Air, TakesPowerFromEveryParticleThatMoves) {
  const SplitOde ode = in_air(1.5);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const State y{deformed(five_by_four(), seed).x, random_vectors(20, 1, seed)};
    const Eigen::VectorXd power = force_at(ode, 0, y).cwiseProduct(y.v).rowwise().sum();
    EXPECT_LT(power.maxCoeff(), 0);
  }
}

TEST(Air, IsTheSameForMotionBackwards) {
  const SplitOde ode = in_air(1.5);
  const State y = deformed(five_by_four(), 1), back{y.x, -y.v};
  EXPECT_EQ(force_at(ode, 0, back), Vectors(-force_at(ode, 0, y)));
  SparseMatrix dx, dv, back_dx, back_dv;
  ode.jacobian(0, y.x, y.v, dx, dv);
  ode.jacobian(0, y.x, -y.v, back_dx, back_dv);
  EXPECT_EQ(largest(back_dv - dv), 0);
  EXPECT_EQ(largest(back_dx + dx), 0);
}

/// There are no derivatives: at rest the Jacobian is right for motion across the sheet and for motion along it.
TEST(Air, HasAJacobianAtItsKinks) {
  const SplitOde ode = in_air(1.5);
  State y = flat();
  SparseMatrix dx, dv;
  ode.jacobian(0, y.x, y.v, dx, dv);
  EXPECT_EQ(largest(dx), 0);
  for (const Eigen::RowVector3d& v : {Eigen::RowVector3d(0, 0, -2), {3, 1, 0}}) {
    y.v.rowwise() = v;
    const Eigen::VectorXd predicted = dv * Eigen::Map<const Eigen::VectorXd>(y.v.data(), y.v.size());
    EXPECT_LE(largest(force_at(ode, 0, y) - Eigen::Map<const Vectors>(predicted.data(), 20, 3)), rounding);
  }
  ode.jacobian(0, y.x, y.v, dx, dv);
  EXPECT_EQ(largest(dx), 0);
  EXPECT_EQ(largest(dv), 0);
}

// --- In time -------------------------------------------------------------------------------------------------------------

Scene small_sheet() {
  Scene scene;
  scene.sheet.grid = {3, 3, 0.4, 0.3};
  scene.sheet.material.density = 0.2;
  return scene;
}

class InTime : public testing::TestWithParam<std::string> {
 protected:
  const solver::Method& method = solver::method(GetParam());

  State run(const model::Cloth& cloth, double end, int steps) const {
    Integrator integrator(cloth.ode, method, tight(), cloth.start);
    EXPECT_EQ(integrate(integrator, end, end / steps).outcome, Outcome::success);
    return integrator.state();
  }
};
INSTANTIATE_TEST_SUITE_P(, InTime, testing::ValuesIn(names(solver::thesis_methods())),
                         [](const auto& test) { return identifier(test.param); });

/// A falling sheet ends at the speed ρ g/c.
TEST_P(InTime, AFallingSheetReachesItsTerminalVelocity) {
  Scene scene = small_sheet();
  scene.sheet.gravity = {0, 0, -9.81};
  scene.sheet.air = 0.5;
  const State y = run(compile(scene), 16, 400);
  EXPECT_LE(largest(y.v.rowwise() - Eigen::RowVector3d(0, 0, -9.81 * 0.2 / 0.5)), 1e-10);
}

/// A free flat sheet in an oscillating wind is translated: ρ x'' = (a + sin ωt) r.
TEST_P(InTime, AFreeSheetFollowsTheWindAtTheOrderOfTheMethod) {
  Scene scene = small_sheet();
  const Wind wind{.load = {1, 0, 2}, .constant = 0.3, .frequency = 4, .drag = 1.5, .lift = 0.5};
  scene.sheet.wind = wind;
  const model::Cloth cloth = compile(scene);
  const auto [a, w, end] = std::tuple(wind.constant, wind.frequency, 0.9);
  const Eigen::RowVector3d r = Eigen::RowVector3d(0.5, 0, 3) / 0.2;
  const Eigen::RowVector3d v = (a * end + (1 - std::cos(w * end)) / w) * r;
  const Eigen::RowVector3d moved = (a * end * end / 2 + end / w - std::sin(w * end) / (w * w)) * r;
  Convergence x_errors, v_errors;
  for (const int n : {40, 80, 160, 320}) {
    const State y = run(cloth, end, n);
    for (Convergence* c : {&x_errors, &v_errors}) c->steps.push_back(end / n);
    x_errors.errors.push_back(largest((y.x - cloth.start.x).rowwise() - moved));
    v_errors.errors.push_back(largest(y.v.rowwise() - v));
  }
  EXPECT_TRUE(has_order(x_errors, method.order));
  EXPECT_TRUE(has_order(v_errors, method.order));
}

TEST(WindAndAir, MoveAHeldSheetAtTheOrderOfBdf2) {
  Scene scene = scene_of(force_case("all_with_a_membrane"), {5, 4, 1, 0.6});
  scene.pins = {{.where = "left edge", .particles = {}}};
  const model::Cloth cloth = compile(scene);
  const double end = 0.5, times[] = {end};
  const State exact = reference::cvode(cloth.ode, cloth.start, 0, times, {.rtol = 1e-11, .size = 1}).states[0];
  Convergence c;
  for (const int n : {50, 100, 200, 400}) {
    Integrator integrator(cloth.ode, solver::method("bdf2"), tight(), cloth.start);
    EXPECT_EQ(integrate(integrator, end, end / n).outcome, Outcome::success);
    c.steps.push_back(end / n);
    c.errors.push_back(largest(integrator.state().x - exact.x));
  }
  EXPECT_TRUE(has_order(c, 2));
  EXPECT_GT(largest(exact.x - cloth.start.x), 0.05);
}

}  // namespace
}  // namespace drape::verify::wind_test
