// Compliant constraints have the energies of the forces that they stand for; `xpbd` projects on them, of first order in the
// sub-steps, and as published.

#include "solver/methods/projection.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::projection_test {
namespace {

using namespace small_problems;
using solver::CompliantConstraint;
using solver::Integrator;
using solver::Outcome;
using Kind = CompliantConstraint::Kind;

constexpr double gravity = 9.81;  // [m/s²]

/// Particles with constraints, which fall along −z, without damping.
SplitOde constrained(const Eigen::VectorXd& mass, const std::vector<CompliantConstraint>& constraints, double g = gravity) {
  const auto n = mass.size();
  SplitOde ode;
  ode.mass = mass;
  ode.stiffness = ode.damping = SparseMatrix(n, n);
  ode.compliant_constraints = [=] { return constraints; };
  ode.unconstrained_force = [=](double, const Vectors&, const Vectors&, Vectors& f) {
    f.setZero(n, 3);
    f.col(2) = -g * mass;
  };
  ode.force =
      ode.explicit_force = [=, weight = ode.unconstrained_force](double t, const Vectors& x, const Vectors& v, Vectors& f) {
        weight(t, x, v, f);
        add_forces(constraints, x, f);
      };
  return ode;
}

Options repeated(int sub_steps, int sweeps) {
  Options options = tight();
  options.sub_steps = sub_steps;
  options.sweeps = sweeps;
  return options;
}

State moved(const SplitOde& ode, std::string_view method, const Options& options, const State& start, double end, double h) {
  Integrator integrator(ode, solver::method(method), options, start);
  EXPECT_EQ(integrate(integrator, end, h).outcome, Outcome::success) << method;
  return integrator.state();
}

// --- The constraints of a sheet -------------------------------------------------------------------------------------------

model::Cloth sheet(const std::vector<model::Override>& overrides) {
  return model::compile(model::load_scene("hung-edge", overrides));
}

/// Positions off the rest state, and velocities.
State crumpled(const model::Cloth& cloth) {
  State y = cloth.start;
  y.x += 0.02 * noise(cloth.ode.particles(), 1);
  y.v += noise(cloth.ode.particles(), 2);
  return y;
}

TEST(CompliantConstraints, HaveTheEnergyOfTensionAndShear) {
  const model::Cloth cloth = sheet({{"grid.n", "6"}, {"forces.gravity", "[0, 0, 0]"}});
  const State y = crumpled(cloth);
  double energy = 0;
  for (const CompliantConstraint& c : cloth.ode.compliant_constraints())
    energy += 0.5 * std::pow(evaluate(c, y.x).C, 2) / c.compliance;
  EXPECT_NEAR(energy, cloth.ode.potential_energy(0, y.x), 1e-12 * energy);
}

TEST(CompliantConstraints, AreWhatTheForceHasBesideTheUnconstrainedOne) {
  for (const auto& overrides : std::vector<std::vector<model::Override>>{
           {{"grid.n", "6"}},
           {{"grid.n", "6"}, {"material.bend", "1e-3"}, {"forces.wind", "[1, 2, 3]"}, {"material.shear_damping", "0.5"}}}) {
    const model::Cloth cloth = sheet(overrides);
    const State y = crumpled(cloth);
    Vectors whole, parts;
    cloth.ode.force(0, y.x, y.v, whole);
    cloth.ode.unconstrained_force(0, y.x, y.v, parts);
    EXPECT_GE(largest(whole - parts), 1);
    add_forces(cloth.ode.compliant_constraints(), y.x, parts);
    EXPECT_LE(largest(whole - parts), 1e-12 * largest(whole));
  }
}

TEST(CompliantConstraints, HaveTheirGradients) {
  const Vectors x = noise(3, 5);
  constexpr double delta = 1e-6;
  for (const CompliantConstraint& c :
       {CompliantConstraint{Kind::distance, {2, 0, 0}, 0.4, 1}, CompliantConstraint{Kind::angle, {1, 2, 0}, 0, 1}}) {
    const auto value = evaluate(c, x);
    for (int k = 0; k < value.particles; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        Vectors there = x, here = x;
        there(c.particles[k], axis) += delta;
        here(c.particles[k], axis) -= delta;
        EXPECT_NEAR((evaluate(c, there).C - evaluate(c, here).C) / (2 * delta), value.gradients[k][axis], 1e-9);
      }
  }
}

TEST(Colours, HaveNoParticleTwice) {
  const auto listed = sheet({{"grid.n", "8"}}).ode.compliant_constraints();
  const auto all = solver::coloured(listed);
  ASSERT_EQ(all.size(), listed.size());
  int colours = 1;
  std::set<int> taken;
  for (const CompliantConstraint& c : all) {
    const std::set<int> ends(c.particles.begin(), c.particles.end());
    if (std::ranges::any_of(ends, [&](int i) { return taken.contains(i); })) {
      taken.clear();
      ++colours;
    }
    taken.insert(ends.begin(), ends.end());
  }
  EXPECT_GE(colours, 16) << "as many as a particle has constraints";
  EXPECT_LE(colours, 40) << "where they are 304";
}

// --- XPBD -----------------------------------------------------------------------------------------------------------------

/// Macklin's spring: a unit mass 1.5 from the origin, rest length 1, compliance 1e-3, without gravity.
const State stretched{(Vectors(2, 3) << 0, 0, 0, 1.5, 0, 0).finished(), Vectors::Zero(2, 3)};
SplitOde spring() {
  SplitOde ode = constrained(Eigen::Vector2d(1, 1), {{Kind::distance, {0, 1, 1}, 1, 1e-3}}, 0);
  ode.pins = {Pin{.particle = 0}};
  return ode;
}

TEST(Xpbd, IsImplicitEulerForOneSpring) {
  const double h = 0.01, W = h * h / 1e-3;
  const SplitOde ode = spring();
  for (const char* method : {"xpbd", "xpbd-jacobi"}) {
    Integrator integrator(ode, solver::method(method), repeated(1, 1), stretched);
    double u = 0.5, v = 0;
    for (int n = 0; n < 200; ++n) {
      ASSERT_EQ(integrator.step(h).outcome, Outcome::success);
      v = (v - W / h * u) / (1 + W);
      u += h * v;
      ASSERT_NEAR(integrator.state().x(1, 0), 1 + u, 1e-12) << method;
      ASSERT_NEAR(integrator.state().v(1, 0), v, 1e-10) << method;
    }
  }
}

TEST(Xpbd, TracksTheExactPeriodOfASpringByItsCompliance) {
  const double omega = std::sqrt(1e3), end = 0.19;  // about a period
  Convergence measured;
  for (const int n : {200, 400, 800, 1600}) {
    measured.steps.push_back(1.0 / n);
    const State y = moved(spring(), "xpbd", repeated(n, 1), stretched, end, end / 10);
    measured.errors.push_back(std::abs(y.x(1, 0) - 1 - 0.5 * std::cos(omega * end)));
  }
  EXPECT_TRUE(has_order(measured, 1));
}

/// The error of sub-steps on a small sheet that swings, of all positions at the end.
Convergence sub_steps_on_a_sheet(const char* method, int sweeps) {
  const model::Cloth cloth = sheet({{"grid.n", "5"}, {"material.tension", "100"}, {"material.damping", "0.05"}});
  const State exact = moved(cloth.ode, "rk4-substeps", {}, cloth.start, 0.1, 1e-4);
  Convergence measured;
  for (const int n : {40, 80, 160, 320}) {
    measured.steps.push_back(1.0 / n);
    const State y = moved(cloth.ode, method, repeated(n, sweeps), cloth.start, 0.1, 0.01);
    measured.errors.push_back((y.x - exact.x).norm());
  }
  return measured;
}

TEST(Xpbd, IsOfFirstOrderInItsSubSteps) {
  for (const char* method : {"xpbd", "xpbd-jacobi"}) EXPECT_TRUE(has_order(sub_steps_on_a_sheet(method, 1), 1)) << method;
  EXPECT_TRUE(has_order(sub_steps_on_a_sheet("xpbd", 4), 1));
}

/// Implicit Euler has the gradients at the end of the step, sweeps those on the way there.
TEST(Xpbd, IsNearlyImplicitEulerAfterManySweeps) {
  DRAPE_SLOW();
  const model::Cloth cloth = sheet({{"grid.n", "5"}, {"material.tension", "3000"}, {"material.damping", "0"}});
  const auto after = [&](const char* method, const Options& options) {
    return moved(cloth.ode, method, options, cloth.start, 0.1, 0.01);
  };
  const State implicit = after("implicit-euler", tight());
  EXPECT_GE(distance(after("xpbd", repeated(1, 3)), implicit), 1e-3);
  for (const auto& [method, sweeps] : {std::pair("xpbd", 600), {"xpbd-jacobi", 6000}}) {
    const State end = after(method, repeated(1, sweeps));
    EXPECT_LE(distance(end, after(method, repeated(1, 2 * sweeps))), 1e-9) << method;
    EXPECT_LE(distance(end, implicit), 1e-3) << method;
    EXPECT_GE(distance(end, implicit), 1e-4) << method;
  }
}

/// One particle between eight held ones: without shares of its mass, eight times the correction would throw it to and fro.
TEST(Xpbd, ConvergesWhereManyConstraintsMeet) {
  constexpr int held = 8;
  State start{Vectors::Zero(held + 1, 3), Vectors::Zero(held + 1, 3)};
  start.x.row(held) << 0.1, 0.05, 0;
  std::vector<CompliantConstraint> spokes;
  std::vector<Pin> pins;
  for (int k = 0; k < held; ++k) {
    start.x.row(k) << std::cos(k * std::numbers::pi / 4), std::sin(k * std::numbers::pi / 4), 0;
    spokes.push_back({Kind::distance, {k, held, held}, 1, 1e-9});
    pins.push_back({.particle = k});
  }
  SplitOde ode = constrained(Eigen::VectorXd::Ones(held + 1), spokes, 0);
  ode.pins = pins;
  for (const char* method : {"xpbd", "xpbd-jacobi"})
    EXPECT_LE(moved(ode, method, repeated(1, 100), start, 0.01, 0.01).x.row(held).norm(), 1e-5) << method;
}

TEST(Xpbd, DampsAsImplicitEulerDoes) {
  SplitOde ode = constrained(masses(), {}, 0);
  const Eigen::MatrixXd D = laplacian(&Spring::d);
  ode.damping = D.sparseView();
  ode.force = ode.explicit_force =
      ode.unconstrained_force = [D](double, const Vectors&, const Vectors& v, Vectors& f) { f = D * v; };
  const State start{noise(particles, 7), noise(particles, 8)}, end = moved(ode, "xpbd", repeated(2, 1), start, 0.6, 0.6);
  const Eigen::MatrixXd M = masses().asDiagonal(), step = (M - 0.3 * D).lu().solve(M);
  EXPECT_LE(largest(end.v - step * step * start.v), 1e-12);
}

TEST(Xpbd, KeepsTheMomentumOfWhatIsFree) {
  SplitOde ode = constrained(masses().head(3), {{Kind::distance, {0, 1, 1}, 0.1, 1e-4}, {Kind::angle, {1, 2, 0}, 0, 1e-3}}, 0);
  const State start{noise(3, 7), noise(3, 8)};
  for (const char* method : {"xpbd", "xpbd-jacobi"}) {
    const State end = moved(ode, method, repeated(3, 2), start, 0.1, 0.01);
    EXPECT_GE(largest(end.v - start.v), 0.1);
    EXPECT_LE(largest(ode.mass.transpose() * (end.v - start.v)), 1e-12) << method;
  }
}

/// The sheet that other codes were measured on: 20 x 20 equal masses, springs along the edges of cells and ten times softer
/// ones along both diagonals, hung by a border.
struct PeerSheet {
  static constexpr int n = 20;
  std::vector<CompliantConstraint> springs;
  SplitOde ode;
  State start{Vectors::Zero(n * n, 3), Vectors::Zero(n* n, 3)};

  static int index(int a, int b) { return a + n * b; }
  void join(int i, int j, double k) {
    springs.push_back({Kind::distance, {i, j, j}, (start.x.row(j) - start.x.row(i)).norm(), 1 / k});
  }

  PeerSheet() {
    constexpr double l = 0.04;  // [m]
    for (int i = 0; i < n * n; ++i) start.x.row(i) << l * (i % n), l * (i / n), 0;
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a) {
        if (a + 1 < n) join(index(a, b), index(a + 1, b), 1e3);
        if (b + 1 < n) join(index(a, b), index(a, b + 1), 1e3);
        if (a + 1 == n || b + 1 == n) continue;
        join(index(a, b), index(a + 1, b + 1), 1e2);
        join(index(a + 1, b), index(a, b + 1), 1e2);
      }
    ode = constrained(Eigen::VectorXd::Constant(n * n, l * l), springs);
    for (int a = 0; a < n; ++a) ode.pins.push_back(Pin{.particle = index(a, n - 1)});
  }
};

/// RMS errors at 0.5 s with steps of 10 ms of the library PositionBasedDynamics: 39.6 mm and 7.38 mm.
TEST(Xpbd, HasThePublishedErrorsOnTheSheetOfOtherCodes) {
  const PeerSheet sheet;
  Options fine;
  fine.verlet_fraction = 0.05;
  const State exact = moved(sheet.ode, "verlet", fine, sheet.start, 0.5, 0.01);
  const auto error = [&](int sub_steps) {
    const State end = moved(sheet.ode, "xpbd", repeated(sub_steps, 1), sheet.start, 0.5, 0.01);
    return std::sqrt((end.x - exact.x).rowwise().squaredNorm().mean());
  };
  EXPECT_NEAR(error(5), 3.96e-2, 0.05 * 3.96e-2);
  EXPECT_NEAR(error(20), 7.38e-3, 0.05 * 7.38e-3);
}

/// What is published of small steps [Macklin et al. 2019]: a chain of 19 links of 0.01 m between unit masses, of which the
/// first is held and the last may be heavy.
struct Chain {
  static constexpr int links = 19;
  double last;  ///< mass [kg]

  /// How much too long it is after some seconds, by steps of 1/60 s: hardly compliant, it should not be.
  double stretch(double duration, int sub_steps, int sweeps) const {
    constexpr double l = 0.01;
    Eigen::VectorXd mass = Eigen::VectorXd::Ones(links + 1);
    mass[links] = last;
    std::vector<CompliantConstraint> all;
    for (int k = 0; k < links; ++k) all.push_back({Kind::distance, {k, k + 1, k + 1}, l, 1e-12});
    SplitOde ode = constrained(mass, all);
    ode.pins = {Pin{.particle = 0}};
    State y{Vectors::Zero(links + 1, 3), Vectors::Zero(links + 1, 3)};
    y.x.col(2) = Eigen::VectorXd::LinSpaced(links + 1, 0, -l * links);
    return -moved(ode, "xpbd", repeated(sub_steps, sweeps), y, duration, 1.0 / 60).x(links, 2) - l * links;
  }
};

TEST(SmallSteps, StretchALightChainByTheSquareOfTheirSize) {
  const Chain light{1};
  Convergence measured;
  for (const int n : {25, 50, 100, 200}) {
    measured.steps.push_back(1.0 / n);
    measured.errors.push_back(light.stretch(2, n, 1));
  }
  EXPECT_TRUE(has_order(measured, 2));
  EXPECT_NEAR(measured.errors[2], 4.7e-5, 0.05 * 4.7e-5);
  EXPECT_NEAR(light.stretch(2, 1, 100), 3.3e-3, 0.1 * 3.3e-3);
}

/// Published: 97.5 m with 100 sweeps a step, 0.98 m with 100 sub-steps; the end swings slowly, so that it depends on the time.
TEST(SmallSteps, HoldAHeavyMassAHundredTimesBetterThanSweeps) {
  const Chain heavy{1e5};
  const double sweeps = heavy.stretch(20, 1, 100), small_steps = heavy.stretch(20, 100, 1);
  EXPECT_GE(sweeps, 50);
  EXPECT_LE(small_steps, 1);
  EXPECT_GE(sweeps / small_steps, 50);
  EXPECT_LE(sweeps / small_steps, 250);
}

}  // namespace
}  // namespace drape::verify::projection_test
