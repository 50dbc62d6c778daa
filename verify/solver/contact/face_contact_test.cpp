// Cloth meets edges and corners of bodies between its particles.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "model/collision/body_faces.hpp"
#include "verify/support/contact_scenes.hpp"

namespace drape::verify::face_contact_test {
namespace {

using contact_scenes::Moment;
using contact_scenes::Trial;

Trial compiled(const std::string& toml) {
  const model::Scene scene = model::parse_scene("name = 'test'\n" + toml, "test");
  return {scene, model::compile(scene)};
}

/// A sheet of four particles falls on a box that is smaller than it, so that no particle meets it.
Trial over_a_box(bool faces) {
  return compiled(fmt::format(
      "grid = {{ n = 2, size = 0.3 }}\nmaterial = {{ density = 0.3, tension = 200, damping = 0.5, shear = 50 }}\n"
      "forces = {{ gravity = [0, 0, -9.81] }}\ncontact = {{ distance = 0.005, faces = {} }}\nend = {{ time = 0.5 }}\n"
      "obstacles = [{{ shape = 'box', size = [0.1, 0.1, 0.1], position = [0.1504, 0.1497, -0.1], friction = 0.5 }}]\n",
      faces));
}

/// Frames in which a triangle of the cloth intersects one of the obstacles.
int intersecting_frames(const Trial& trial, const std::vector<Moment>& moments) {
  const model::ClothSurface surface(*trial.cloth.garment);
  std::vector<model::PosedObstacle> bodies;
  for (const model::ObstacleRule& rule : trial.scene.obstacles) bodies.emplace_back(rule, 0);
  return static_cast<int>(std::ranges::count_if(moments, [&](const Moment& moment) {
    return !model::body_intersections(surface, bodies, moment.t, moment.y.x).empty();
  }));
}

/// Such a sheet lies on a box that is little smaller, on a slope or on one that moves. Its particles are beside the box.
Trial on_a_box(double slope, double friction, const std::string& motion) {
  const double a = slope * M_PI / 180;
  return compiled(fmt::format(
      "grid = {{ n = 2, size = 0.3 }}\nmaterial = {{ density = 0.3, tension = 200, damping = 0.5, shear = 50 }}\n"
      "forces = {{ gravity = [{}, 0, {}] }}\ncontact = {{ distance = 0.005, faces = true }}\nend = {{ time = 0.1 }}\n"
      "obstacles = [{{ shape = 'box', size = [0.28, 0.28, 0.1], friction = {}, motion = [{}] }}]\n",
      9.81 * std::sin(a), -9.81 * std::cos(a), friction, motion));
}

class FaceContactBy : public testing::TestWithParam<std::string> {
 protected:
  /// What velocities may be off [m/s]: those of Verlet's method are half a step of the weight ahead of the contacts.
  static double within_a_step() { return GetParam() == "verlet" ? 0.51 * 9.81 * 0.01 : 1e-3; }
};

INSTANTIATE_TEST_SUITE_P(All, FaceContactBy,
                         testing::Values("imex-euler", "implicit-euler", "sbdf2", "bdf2", "midpoint", "verlet"),
                         [](const auto& method) {
                           std::string name = method.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(FaceContactBy, HoldsASheetWhoseParticlesMeetNothing) {
  const Trial trial = over_a_box(true);
  const std::vector<Moment> moments = contact_scenes::run(trial, GetParam(), 0.01);
  EXPECT_EQ(intersecting_frames(trial, moments), 0);
  const double weight = 9.81 * trial.cloth.ode.mass.sum(), falls = 0.1;
  // Methods of two steps do not give h times the force of a step where it changes abruptly.
  const bool of_two_steps = GetParam().ends_with("bdf2");
  for (std::size_t k = 1; k < moments.size(); ++k) {
    const double gained = (trial.cloth.ode.mass.transpose() * (moments[k].y.v - moments[k - 1].y.v))[2];
    const bool jumps = of_two_steps && moments[k].t < 2 * falls;
    EXPECT_NEAR(gained, moments[k].contacts.impulse[2] - 0.01 * weight, jumps ? 0.05 * falls * weight : 1e-4 * weight)
        << moments[k].t;
  }
}

TEST_P(FaceContactBy, SlidesAndSticksByCoulombsLaw) {
  for (const double friction : {0.0, 0.3, 1.0}) {
    const Trial trial = on_a_box(30, friction, "{ time = 0, position = [0.1504, 0.1497, -0.055] }");
    const std::vector<Moment> moments = contact_scenes::run(trial, GetParam(), 0.01);
    const double a = M_PI / 6, speed = 0.1 * 9.81 * std::max(0.0, std::sin(a) - friction * std::cos(a));
    EXPECT_NEAR(moments.back().y.v.col(0).mean(), speed, 0.03 * speed + within_a_step()) << friction;
  }
}

TEST_P(FaceContactBy, TakesTheSheetWithABodyThatMoves) {
  const Trial trial =
      on_a_box(0, 1, "{ time = 0, position = [0.1504, 0.1497, -0.055] }, { time = 1, position = [0.3504, 0.1497, 0.145] }");
  const std::vector<Moment> moments = contact_scenes::run(trial, GetParam(), 0.01);
  const Eigen::RowVector3d v = moments.back().y.v.colwise().mean(),
                           way = (moments.back().y.x - moments.front().y.x).colwise().mean();
  EXPECT_NEAR(v[0], 0.2, within_a_step());
  EXPECT_NEAR(v[2], 0.2, within_a_step());
  EXPECT_NEAR(way[2], 0.1 * 0.2, 1.01 * 0.01 * 0.2) << "picked up in the first step";
  EXPECT_EQ(intersecting_frames(trial, moments), 0);
}

TEST_P(FaceContactBy, IsAskedFor) {
  const Trial trial = over_a_box(false);
  EXPECT_GT(intersecting_frames(trial, contact_scenes::run(trial, GetParam(), 0.01)), 0);
}

}  // namespace
}  // namespace drape::verify::face_contact_test
