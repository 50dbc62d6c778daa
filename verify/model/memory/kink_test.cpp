// Laws have kinks where one branch ends and another begins: integrators can end their steps there, CVODE and ARKODE begin there
// again.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/cloth.hpp"
#include "model/memory/stress_law.hpp"
#include "reference/sundials/arkode.hpp"
#include "reference/sundials/cvode.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::kink_test {
namespace {

using model::Cloth;
using model::CurveLaw;
using model::DahlLaw;
using model::JenkinLaw;
using model::Polyline;
using model::Scene;
using small_problems::tight;
using solver::Outcome;

TEST(StressLaw, ChangesItsBranchAtKinks) {
  const CurveLaw curve({Polyline({{0, 0}, {0.5, 1}, {2, 6}}), Polyline({{0.1, 0}, {0.6, 0.3}, {1, 1}})}, true, 0);
  const int soft = curve.branch(0.3, 1, 0.3), stiff = curve.branch(1, 1, 1);
  const int back = curve.branch(0.9, -1, 1), lower = curve.branch(0.4, -1, 1), slack = curve.branch(0.05, -1, 1);
  EXPECT_NE(soft, stiff);
  EXPECT_NE(stiff, back) << "unloads";
  EXPECT_NE(back, lower) << "kink of the unloading branch";
  EXPECT_NE(lower, slack) << "residual strain";
  EXPECT_EQ(curve.branch(0.9, 1, 1), back) << "forth on the same branch";
  EXPECT_EQ(curve.branch(-0.05, -1, 1), slack) << "there is no kink at no strain";
  EXPECT_EQ(curve.branch(-1, -1, 1), stiff);
  EXPECT_EQ(curve.branch(1, 1e-12, 1), back) << "stands still";

  const CurveLaw elastic({Polyline({{0, 0}, {0.5, 1}, {2, 6}}), {}}, false, 0);
  EXPECT_EQ(elastic.branch(1, 1, 1), elastic.branch(1, -1, 1));
  EXPECT_EQ(elastic.branch(0.1, 1, 1), elastic.branch(-3, -1, 1));
  EXPECT_NE(elastic.branch(0.1, 1, 1), elastic.branch(1, 1, 1));

  const JenkinLaw jenkin(2, 0.3);
  EXPECT_EQ(jenkin.branch(0, 1, 1.9), jenkin.branch(0, -1, 2)) << "sticks";
  EXPECT_NE(jenkin.branch(0, 1, 1.9), jenkin.branch(0, 1, 2)) << "slides";
  EXPECT_NE(jenkin.branch(0, -1, -2), jenkin.branch(0, 1, 2));

  const DahlLaw dahl(2, 0.3);
  EXPECT_NE(dahl.branch(0, 1, 0), dahl.branch(0, -1, 0));
  EXPECT_EQ(dahl.branch(0, 0, 0), dahl.branch(0, 1, 0));
}

TEST(StressLaw, OfASmoothCurveHasOneBranchEachWay) {
  const CurveLaw curve(model::StressCurve{Polyline({{0, 0}, {0.5, 1}, {2, 6}}), {}}.smoothed(), true, 0);
  EXPECT_EQ(curve.branch(0.1, 1, 0.1), curve.branch(1.5, -1, 2));
}

/// A mass on one edge whose slope rises from C1 to C2 at a strain: it swings in pieces of sines, with a period in closed form.
class KinkedSwing {
 public:
  static constexpr double C1 = 100, C2 = 1000, kink = 0.05, amplitude = 0.15, length = 0.2, width = 0.05;

  KinkedSwing() {
    scene_.sheet.grid = {.nu = 2, .nv = 1, .size_u = length, .size_v = width};
    model::Material& m = scene_.sheet.material;
    m.tension = {C1, C1};
    m.weft_curve.loading = Polyline({{0, 0}, {kink, C1 * kink}, {1, C1 * kink + C2 * (1 - kink)}});
    scene_.pins = {{.where = "left edge", .particles = {}}};
  }

  double period() const {
    const double mass = model::compile(scene_).ode.mass[1], per_modulus = width / (mass * length);
    const double w1 = std::sqrt(C1 * per_modulus), w2 = std::sqrt(C2 * per_modulus);
    const double middle = kink * (1 - C1 / C2), reach = amplitude - middle;  // of the sine beyond the kink
    const double phase = std::acos((kink - middle) / reach);
    const double speed = reach * w2 * std::sin(phase);
    return 2 * (phase / w2 + (std::numbers::pi / 2 + std::atan(kink * w1 / speed)) / w1);
  }

  struct Result {
    double error;
    std::int64_t kinks, steps;
  };

  /// After one period, by about this number of steps.
  Result run(const char* method, int steps, bool events) const {
    const Cloth cloth = model::compile(scene_);
    solver::State y = cloth.start;
    y.x(1, 0) = y.x(0, 0) + (1 + amplitude) * length;
    y.z = Eigen::VectorXd();
    solver::Options options = tight();
    options.ends_at_kinks = events;
    solver::Integrator integrator(cloth.ode, solver::method(method), options, y);
    EXPECT_EQ(integrate(integrator, period(), period() / steps).outcome, Outcome::success);
    const double error = (integrator.state().x - y.x).norm() + period() * integrator.state().v.norm();
    return {error / length, cloth.ode.work->count("kinks"), cloth.ode.work->count("steps")};
  }

 private:
  Scene scene_;
};

class EndingAtKinks : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, EndingAtKinks, testing::Values("esdirk3", "bdf3", "ros3p"),
                         [](const auto& row) { return std::string(row.param); });

TEST_P(EndingAtKinks, KeepsTheThirdOrder) {
  const KinkedSwing swing;
  Convergence c;
  for (const int steps : {320, 640, 1280, 2560}) {
    const auto [error, kinks, taken] = swing.run(GetParam(), steps, true);
    EXPECT_EQ(kinks, 2) << "back and forth";
    EXPECT_LE(taken, steps + 2);
    c.steps.push_back(1.0 / steps);
    c.errors.push_back(error);
  }
  EXPECT_TRUE(has_order(c, 3, 0.15));
}

TEST(StepsAcrossKinks, CostAccuracy) {
  const KinkedSwing swing;
  double worst = 0;
  for (const int steps : {600, 620, 640, 660})
    worst = std::max(worst, swing.run("esdirk3", steps, false).error / swing.run("esdirk3", steps, true).error);
  EXPECT_GT(worst, 10);
}

TEST(Kinks, EndStepsWithSubStepsAsWell) {
  const KinkedSwing swing;
  Convergence c;
  for (const int steps : {160, 320, 640, 1280}) {
    const auto [error, kinks, taken] = swing.run("verlet", steps, true);
    EXPECT_NEAR(kinks, 2, 1) << "of long steps some end so far before it that the next one is cut as well";
    c.steps.push_back(1.0 / steps);
    c.errors.push_back(error);
  }
  EXPECT_TRUE(has_order(c, 2));
}

TEST(Kinks, ChangeNothingWhereThereAreNone) {
  const small_problems::Problem problem = small_problems::free_particles();
  solver::State end[2];
  for (const bool events : {false, true}) {
    solver::Options options = tight();
    options.ends_at_kinks = events;
    solver::Integrator integrator(problem.ode, solver::method("bdf2"), options, problem.exact(0), 0);
    EXPECT_EQ(integrate(integrator, 0.5, 0.01).outcome, Outcome::success);
    end[events] = integrator.state();
  }
  EXPECT_EQ(end[0].x, end[1].x);
}

TEST(References, BeginAgainAtKinks) {
  Scene scene;
  scene.sheet.grid = {.nu = 3, .nv = 3, .size_u = 0.2, .size_v = 0.2};
  model::Material& m = scene.sheet.material;
  m.density = 0.2;
  m.tension = {40, 40};
  m.damping = {0.05, 0.05};
  m.shear = 4;
  m.weft_curve = {Polyline({{0, 0}, {0.01, 0.4}, {0.2, 30}}), Polyline({{0, 0}, {0.5, 0.3}, {1, 1}})};
  m.friction = {.law = model::FrictionKind::jenkin, .shear = 0.1, .shear_onset = 0.02, .bend = {}};
  scene.sheet.gravity = {6, -4, -7};
  scene.pins = {{.where = "left edge", .particles = {}}};
  const Cloth cloth = model::compile(scene);
  const std::vector<double> times{0.1, 0.25};
  const auto bdf = reference::cvode(cloth.ode, cloth.start, 0, times, {.rtol = 1e-9, .size = 0.2});
  const auto dirk = reference::arkode_esdirk(cloth.ode, cloth.start, 0, times, {.rtol = 1e-9, .size = 0.2});
  EXPECT_GT(cloth.ode.work->count("cvode/restarts"), 2);
  EXPECT_NEAR(cloth.ode.work->count("cvode/restarts"), cloth.ode.work->count("arkode/restarts"), 10);
  for (int k = 0; k < 2; ++k) EXPECT_LT((bdf.states[k].x - dirk.states[k].x).norm(), 5e-8 * 0.2);
}

}  // namespace
}  // namespace drape::verify::kink_test
