// Pins along directions that are not those of axes: a scene and the same scene turned in space move alike.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "solver/integrator.hpp"
#include "solver/stage/stage_solver.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::oblique_pins_test {
namespace {

using model::Cloth;
using model::PinRule;
using model::Scene;
using solver::State;
using solver::Vectors;

const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();

Vectors turned(const Vectors& a, const Eigen::Matrix3d& R) { return a * R.transpose(); }

/// A sheet that slides along the line x with its left edge and in a moving plane with a corner.
Scene scene() {
  const std::vector<model::Override> small{{"grid.n", "[5, 4]"}, {"material.damping", "0.02"}, {"material.tension", "20"}};
  Scene found = model::load_scene("hung-edge", small);
  PinRule edge{.where = "left edge", .particles = {}}, corner{.where = "", .particles = {{4, 3}}};
  edge.directions = {false, true, true};
  edge.velocity = {0, 0.1, 0};
  corner.directions = {false, false, true};
  corner.velocity = {0, 0, 0.2};
  found.pins = {edge, corner};
  return found;
}

/// The same, turned.
Scene turned_scene() {
  Scene found = scene();
  found.sheet.gravity = turn * found.sheet.gravity;
  std::vector<PinRule> pins;
  for (PinRule rule : found.pins) {
    rule.velocity = turn * rule.velocity;
    for (int c = 0; c < 3; ++c) {
      if (!rule.directions[c]) continue;
      rule.direction = turn.col(c);
      pins.push_back(rule);
    }
  }
  found.pins = pins;
  return found;
}

struct Turned {
  Cloth straight = model::compile(scene()), oblique = model::compile(turned_scene());

  Turned() { oblique.start = {turned(straight.start.x, turn), turned(straight.start.v, turn), straight.start.z}; }

  double distance(const State& of_straight, const State& of_oblique) const {
    return std::max((turned(of_straight.x, turn) - of_oblique.x).cwiseAbs().maxCoeff(),
                    (turned(of_straight.v, turn) - of_oblique.v).cwiseAbs().maxCoeff());
  }
};

State after(const Cloth& cloth, const solver::Method& method, const solver::Options& options) {
  solver::Integrator integrator(cloth.ode, method, options, cloth.start);
  const solver::RunResult run = integrate(integrator, 0.1, 0.002);
  EXPECT_EQ(run.outcome, solver::Outcome::success) << method.name << ": " << run.message;
  return integrator.state();
}

/// How far a sheet moves that is not turned back: what the comparisons have to be small beside.
constexpr double moved = 1e-2;

TEST(ObliquePins, AreThoseOfTheTurnedScene) {
  const Turned both;
  ASSERT_EQ(both.straight.ode.pins.size(), both.oblique.ode.pins.size());
  for (std::size_t k = 0; k < both.straight.ode.pins.size(); ++k) {
    const solver::Pin &straight = both.straight.ode.pins[k], &oblique = both.oblique.ode.pins[k];
    EXPECT_TRUE(oblique.held.isApprox(turn * straight.held * turn.transpose(), 1e-14));
    EXPECT_TRUE(oblique.prescribed().isApprox(turn * straight.prescribed(), 1e-14));
    EXPECT_TRUE(oblique.oblique());
  }
  EXPECT_EQ(both.straight.plan.pinned_dofs, both.oblique.plan.pinned_dofs);
}

TEST(ObliquePins, AreMovedByTheForceAlongThem) {
  const Turned both;
  const State a = after(both.straight, solver::method("verlet"), {});
  const State b{turned(a.x, turn), turned(a.v, turn), a.z};
  Vectors given, of_turned;
  both.straight.given(0.1, a.x, a.v, given);
  both.oblique.given(0.1, b.x, b.v, of_turned);
  ASSERT_GE(given.cwiseAbs().maxCoeff(), 1e-2);
  EXPECT_LE((turned(given, turn) - of_turned).cwiseAbs().maxCoeff(), 1e-10);
  solver::filter(both.oblique.ode.pins, of_turned);
  EXPECT_LE(of_turned.cwiseAbs().maxCoeff(), 1e-12) << "across them they do no work";
}

class ObliquePinsWith : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, ObliquePinsWith, testing::ValuesIn(small_problems::names(solver::methods())),
                         [](const auto& test) { return small_problems::identifier(test.param); });

TEST_P(ObliquePinsWith, MoveAsTheTurnedScene) {
  const Turned both;
  const solver::Method& method = solver::method(GetParam());
  const State straight = after(both.straight, method, small_problems::tight()),
              oblique = after(both.oblique, method, small_problems::tight());
  ASSERT_GE((straight.x - both.straight.start.x).cwiseAbs().maxCoeff(), moved);
  for (const solver::Pin& pin : both.oblique.ode.pins) {
    const Eigen::Vector3d v = oblique.v.row(pin.particle);
    EXPECT_LE((pin.held * v - pin.prescribed()).norm(), 1e-12) << "it leaves its path";
  }
  EXPECT_LE(both.distance(straight, oblique), 1e-7);
}

TEST(ObliquePins, AreThoseOfAllStageSolvers) {
  const Turned both;
  for (const solver::StageKind& kind : solver::stage_kinds()) {
    solver::Options options = small_problems::tight();
    options.stage = &kind;
    options.loop_tolerance = 1e-11;
    const auto& method = solver::method("implicit-euler");
    EXPECT_LE(both.distance(after(both.straight, method, options), after(both.oblique, method, options)), 1e-7) << kind.name;
  }
}

TEST(ObliquePins, AreThoseOfAllPeers) {
  const Turned both;
  const std::vector<double> times{0.1};
  for (const reference::PeerSolver& peer : reference::peer_solvers()) {
    const auto solve = [&](const Cloth& cloth) {
      return peer.solve(cloth.ode, cloth.start, 0, times, {.rtol = 1e-9, .size = 1}).states.back();
    };
    EXPECT_LE(both.distance(solve(both.straight), solve(both.oblique)), 1e-5) << peer.name;
  }
}

}  // namespace
}  // namespace drape::verify::oblique_pins_test
