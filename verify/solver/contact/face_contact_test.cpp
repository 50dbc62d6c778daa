// Cloth meets edges and corners of bodies between its particles.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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
  return static_cast<int>(std::ranges::count_if(
      moments, [&](const Moment& moment) { return model::body_intersections(surface, bodies, moment.t, moment.y.x) > 0; }));
}

class FaceContactBy : public testing::TestWithParam<std::string> {};

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
  const double weight = 9.81 * trial.cloth.ode.mass.sum();
  for (std::size_t k = 1; k < moments.size(); ++k) {
    const double gained = (trial.cloth.ode.mass.transpose() * (moments[k].y.v - moments[k - 1].y.v))[2];
    EXPECT_NEAR(gained, moments[k].contacts.impulse[2] - 0.01 * weight, 1e-3 * 0.01 * weight) << moments[k].t;
  }
}

TEST_P(FaceContactBy, IsAskedFor) {
  const Trial trial = over_a_box(false);
  EXPECT_GT(intersecting_frames(trial, contact_scenes::run(trial, GetParam(), 0.01)), 0);
}

}  // namespace
}  // namespace drape::verify::face_contact_test
