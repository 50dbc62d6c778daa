// What a scene says of its sheet: which particles are pinned, how it starts, and the numbers that describe it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "model/cloth.hpp"
#include "model/sheet/edges.hpp"

namespace drape::verify::scene_test {
namespace {

using model::compile;
using model::PinRule;
using model::Scene;
using testing::Each;
using testing::ElementsAre;
using testing::Field;

// --- Pins and start
// ------------------------------------------------------------------------------------------------------------

/// A 4 × 3 sheet; particles 0 … 3 are the lower edge.
Scene pinned(std::vector<PinRule> rules) {
  Scene scene;
  scene.sheet.grid = {4, 3, 3, 2};
  scene.pins = std::move(rules);
  return scene;
}

PinRule at(const std::string& place) { return {.where = place, .particles = {}}; }

std::vector<int> particles_at(const std::string& place) {
  std::vector<int> particles;
  for (const auto& pin : pins(pinned({at(place)}))) particles.push_back(pin.particle);
  return particles;
}

TEST(Pins, HaveNamedPlaces) {
  EXPECT_THAT(model::pin_places(),
              ElementsAre("left edge", "right edge", "lower edge", "upper edge", "border", "corners", "upper corners", "all"));
  EXPECT_THAT(particles_at("left edge"), ElementsAre(0, 4, 8));
  EXPECT_THAT(particles_at("right edge"), ElementsAre(3, 7, 11));
  EXPECT_THAT(particles_at("lower edge"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(particles_at("upper edge"), ElementsAre(8, 9, 10, 11));
  EXPECT_THAT(particles_at("border"), ElementsAre(0, 1, 2, 3, 4, 7, 8, 9, 10, 11));
  EXPECT_THAT(particles_at("corners"), ElementsAre(0, 3, 8, 11));
  EXPECT_THAT(particles_at("upper corners"), ElementsAre(8, 11));
  EXPECT_THAT(particles_at("all"), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
}

TEST(Pins, OfAnUnknownPlaceAreAnError) { EXPECT_THROW(pins(pinned({at("middle")})), std::invalid_argument); }

TEST(Pins, MayNameParticles) {
  const auto all = pins(pinned({{.where = "", .particles = {{2, 1}, {0, 0}}}}));
  EXPECT_THAT(all, ElementsAre(Field(&solver::Pin::particle, 0), Field(&solver::Pin::particle, 6)));
}

TEST(Pins, FixAllDirectionsUnlessTold) {
  PinRule rule = at("upper corners");
  EXPECT_THAT(pins(pinned({rule})), Each(Field(&solver::Pin::held, solver::axes(true, true, true))));
  rule.directions = {false, true, false};
  EXPECT_THAT(pins(pinned({rule})), Each(Field(&solver::Pin::held, solver::axes(false, true, false))));
}

TEST(Pins, ThatOverlapMergeDirectionsAndTheLaterVelocityWins) {
  PinRule left = at("left edge"), lower = at("lower edge");
  left.directions = {true, true, false};
  left.velocity = {1, 2, 3};
  lower.directions = {false, true, true};
  lower.velocity = {4, 5, 6};
  const auto all = pins(pinned({left, lower}));
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0].particle, 0);
  EXPECT_TRUE(all[0].all());
  EXPECT_EQ(all[0].velocity, Eigen::Vector3d(1, 5, 6));
  EXPECT_EQ(all[1].velocity, Eigen::Vector3d(0, 5, 6));
  EXPECT_EQ(all[4].velocity, Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(compile(pinned({left, lower})).plan.pinned_dofs, 3 + 3 * 2 + 2 * 2);
}

TEST(Pins, HoldADirectionOfTheirOwn) {
  PinRule rule = at("upper corners");
  rule.direction = {3, 0, 4};
  rule.velocity = {5, 7, 0};  // of which 3 are along it
  for (const solver::Pin& pin : pins(pinned({rule}))) {
    EXPECT_TRUE(pin.held.isApprox(Eigen::Vector3d(0.6, 0, 0.8) * Eigen::RowVector3d(0.6, 0, 0.8), 1e-15)) << pin.held;
    EXPECT_TRUE(pin.prescribed().isApprox(Eigen::Vector3d(1.8, 0, 2.4), 1e-15)) << pin.prescribed();
    EXPECT_TRUE(pin.oblique());
    EXPECT_FALSE(pin.fixed(0) || pin.fixed(1) || pin.fixed(2) || pin.all());
  }
  EXPECT_EQ(compile(pinned({rule})).plan.pinned_dofs, 2);
  rule.direction = {0, -2, 0};
  for (const solver::Pin& pin : pins(pinned({rule}))) EXPECT_FALSE(pin.oblique()) << "that of an axis";
}

/// Both velocities are kept of directions that are not orthogonal; what is held by the later rule is not held again.
TEST(Pins, OfSeveralDirectionsAllHold) {
  PinRule first = at("left edge"), second = at("left edge");
  first.direction = {1, 1, 0};
  first.velocity = {2, 0, 0};
  second.directions = {true, false, false};
  second.velocity = {5, 0, 0};
  for (const solver::Pin& pin : pins(pinned({first, second}))) {
    EXPECT_TRUE(pin.held.isApprox(Eigen::Matrix3d(solver::axes(true, true, false)), 1e-15)) << pin.held;
    EXPECT_NEAR(pin.velocity[0], 5, 1e-14);
    EXPECT_NEAR(pin.velocity[0] + pin.velocity[1], 2, 1e-14);
  }
  second.direction = {-2, -2, 0};
  second.velocity = {0, 8, 0};
  for (const solver::Pin& pin : pins(pinned({first, second}))) {
    EXPECT_NEAR(pin.held.trace(), 1, 1e-15);
    EXPECT_TRUE(pin.prescribed().isApprox(Eigen::Vector3d(4, 4, 0), 1e-14)) << pin.prescribed();
  }
}

TEST(Start, IsFlatInItsPlaneStretchedAndMovesAsAWhole) {
  Scene scene = pinned({});
  scene.start.stretch = {1.1, 0.9};
  scene.start.velocity = {1, 2, 3};
  const solver::State horizontal = compile(scene).start;
  EXPECT_EQ(horizontal.x.row(11), Eigen::RowVector3d(3 * 1.1, 2 * 0.9, 0));
  EXPECT_EQ(horizontal.x.row(0), Eigen::RowVector3d(0, 0, 0));
  EXPECT_EQ(horizontal.v, solver::Vectors(Eigen::RowVector3d(1, 2, 3).replicate(12, 1)));
  scene.start.plane = model::Plane::vertical;
  EXPECT_EQ(compile(scene).start.x.row(11), Eigen::RowVector3d(3 * 1.1, 0, 2 * 0.9));
}

/// A vertical sheet with three waves along the weft.
Scene pleated() {
  Scene scene;
  scene.sheet.grid = {25, 4, 1.2, 0.6};
  scene.start.plane = model::Plane::vertical;
  scene.start.pleats = {3, 65};
  return scene;
}

TEST(Start, WithPleatsKeepsTheLengthOfEveryEdge) {
  Scene scene = pleated();
  for (const double degrees : {0.0, 30.0, 65.0, 89.9}) {
    scene.start.pleats.degrees = degrees;
    const solver::State y = compile(scene).start;
    for (const model::Edge& edge : edges(scene.sheet.grid))
      EXPECT_NEAR((y.x.row(edge.j) - y.x.row(edge.i)).norm(), edge.length, 1e-15) << edge.i << " to " << edge.j;
  }
}

TEST(Start, WithPleatsKeepsTheWarpStraightAndGathersTheWeft) {
  const Scene scene = pleated();
  const model::Grid& grid = scene.sheet.grid;
  const solver::State y = compile(scene).start;
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const Eigen::RowVector3d below(y.x(grid.index(a, 0), 0), y.x(grid.index(a, 0), 1), b * grid.spacing_v());
      EXPECT_LE((y.x.row(grid.index(a, b)) - below).norm(), 1e-15);
    }
  const double gathered = std::cyl_bessel_j(0, 65 * std::numbers::pi / 180);  // the mean of cos(θ sin φ)
  EXPECT_NEAR(y.x(24, 0), 1.2 * gathered, 1e-6);
  EXPECT_NEAR(y.x(24, 1), 0, 1e-15);
}

TEST(Start, WithPleatsHasSoManyWaves) {
  const solver::State y = compile(pleated()).start;
  const auto slope = [&](int edge) { return y.x(edge + 1, 1) - y.x(edge, 1); };
  int turns = 0;
  for (int edge = 0; edge + 1 < 24; ++edge) turns += slope(edge) * slope(edge + 1) < 0;
  EXPECT_EQ(turns, 5);  // three crests and two troughs between them, the sheet begins and ends in troughs
  EXPECT_NEAR(std::atan2(slope(0), y.x(1, 0)), 65 * std::numbers::pi / 180 * std::sin(2 * std::numbers::pi * 3 * 0.5 / 24),
              1e-14);
}

TEST(Start, WithoutPleatsIsNotTouched) {
  Scene scene = pleated();
  scene.start.pleats = {};
  solver::Vectors x = scene.sheet.grid.parameters();
  x.col(1).swap(x.col(2));
  EXPECT_EQ(compile(scene).start.x, x);
}

TEST(Start, OfPinnedParticlesHasThePrescribedVelocity) {
  PinRule rule = at("left edge");
  rule.directions = {true, false, true};
  rule.velocity = {4, 5, 6};
  Scene scene = pinned({rule});
  scene.start.velocity = {1, 2, 3};
  const solver::Vectors v = compile(scene).start.v;
  EXPECT_EQ(v.row(4), Eigen::RowVector3d(4, 2, 6));
  EXPECT_EQ(v.row(5), Eigen::RowVector3d(1, 2, 3));
}

TEST(SceneNumbers, AreTheLargerOfWeftAndWarp) {
  Scene scene;
  scene.sheet.grid = {11, 5, 1, 2};
  scene.sheet.material.density = 0.5;
  scene.sheet.material.tension = {3, 100};
  scene.sheet.material.damping = {2, 10};
  const double h = 0.1;
  EXPECT_EQ(size(scene), 2);
  EXPECT_NEAR(numerical_stiffness(scene, h), h * h * 100 / (0.5 * 0.5 * 0.5), 1e-12);
  EXPECT_NEAR(stiffness_to_damping(scene, h), 1, 1e-12);
  scene.sheet.material.tension = {3, 1};
  EXPECT_NEAR(numerical_stiffness(scene, h), h * h * 3 / (0.5 * 0.1 * 0.1), 1e-12);
  EXPECT_NEAR(stiffness_to_damping(scene, h), 0.15, 1e-12);
}

TEST(SceneNumbers, KnowSheetsWithoutDampingOrTension) {
  Scene scene;
  EXPECT_EQ(stiffness_to_damping(scene, 1), 0);
  EXPECT_EQ(numerical_stiffness(scene, 1), 0);
  scene.sheet.material.tension.weft = 1;
  EXPECT_EQ(stiffness_to_damping(scene, 1), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace drape::verify::scene_test
