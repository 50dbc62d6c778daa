// Detection of collisions by rays: against all triangles, against half-spaces where both apply, and where only rays see.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/obstacles/contacts.hpp"
#include "model/obstacles/polygons.hpp"
#include "model/obstacles/triangle_hierarchy.hpp"
#include "verify/support/contact_scenes.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/obstacles.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::detection_test {
namespace {

using namespace contact_scenes;
using Eigen::Vector3d;
using model::TriangleHierarchy;
using model::TriangleMesh;
using model::Vectors;
using testing::HasSubstr;

// --- Ways and triangles ------------------------------------------------------------------------------------------------------

/// The part of a way after which it is within a distance of a triangle, infinite if it stays away: distances are convex along
/// the way, so that their least is found by trisection and where they fall to that distance before it by bisection.
double part_to(const model::Corners& corners, const Vector3d& from, const Vector3d& to, double distance) {
  const auto at = [&](double part) {
    const Vector3d p = from + part * (to - from);
    return (p - model::nearest_on_triangle(corners, p).point).norm();
  };
  if (at(0) <= distance) return 0;
  double low = 0, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double one = low + (high - low) / 3, other = high - (high - low) / 3;
    if (at(one) < at(other))
      high = other;
    else
      low = one;
  }
  if (at(high) > distance) return std::numeric_limits<double>::infinity();
  low = 0;
  for (int k = 0; k < 100; ++k) {
    const double middle = (low + high) / 2;
    (at(middle) > distance ? low : high) = middle;
  }
  return high;
}

TEST(FirstWithin, IsThatOfAllTriangles) {
  constexpr double distance = 0.02;
  for (const TriangleMesh& mesh : {spiky_mesh(0.5), spiky_mesh(1), box_mesh({1, 0.01, 1.5})}) {
    const TriangleHierarchy hierarchy(mesh);
    const std::vector<Vector3d> starts = random_points(150, 1.5, 3), ends = random_points(150, 1.5, 4);
    int hits = 0;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      double first = std::numeric_limits<double>::infinity();
      for (const auto& triangle : mesh.triangles)
        first = std::min(first, part_to(corners(mesh, triangle), starts[k], ends[k], distance));
      std::int64_t boxes = 0;
      const std::optional<double> found = hierarchy.first_within(starts[k], ends[k], distance, boxes);
      ASSERT_EQ(found.has_value(), first <= 1) << k;
      if (!found) continue;
      ++hits;
      EXPECT_NEAR(*found, first, 1e-9) << k;
    }
    EXPECT_GT(hits, 20);
    EXPECT_LT(hits, 140);
  }
}

TEST(FirstWithin, SeesWhatIsAlongTheAxes) {
  const TriangleHierarchy box(box_mesh({2, 2, 2}));
  std::int64_t boxes = 0;
  EXPECT_NEAR(box.first_within({0, 0, 3}, {0, 0, -3}, 0.5, boxes).value(), 0.25, 1e-12);
  EXPECT_EQ(box.first_within({0, 0, 1.5}, {0, 0, 1.5}, 0.5, boxes).value(), 0);                     // no way at all
  EXPECT_EQ(box.first_within({-3, 0, 1.6}, {3, 0, 1.6}, 0.5, boxes), std::nullopt);                 // beside it
  EXPECT_EQ(box.first_within({0, 0, 3}, {0, 0, 1.6}, 0.5, boxes), std::nullopt);                    // too short
  EXPECT_NEAR(box.first_within({-3, 1.3, 1.4}, {3, 1.3, 1.4}, 0.5, boxes).value(), 1.0 / 3, 1e-6);  // grazes an edge
}

/// Boxes that a way looks into on average.
double boxes_a_way(int vertices) {
  const model::Polygons sphere = model::ringed_sphere(vertices);
  const TriangleHierarchy hierarchy({"sphere", sphere.vertices, fan_triangles(sphere)});
  const std::vector<Vector3d> starts = random_points(500, 2, 5), ends = random_points(500, 2, 6);
  std::int64_t boxes = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) hierarchy.first_within(starts[k], ends[k], 1e-5, boxes);
  return static_cast<double>(boxes) / static_cast<double>(starts.size());
}

TEST(FirstWithin, LooksIntoBoxesThatGrowLikeTheLogarithmOfTheTriangles) {
  const double few = boxes_a_way(250), more = boxes_a_way(2000), many = boxes_a_way(16000);
  EXPECT_LT(many, 15);                         // of 32 000 triangles; without leaving out what is behind the first, 20
  EXPECT_LT(many - more, 1.5 * (more - few));  // eight times as many triangles cost the same again
}

// --- Contacts ----------------------------------------------------------------------------------------------------------------

const std::string by_rays = "contact = { distance = 0.01, detection = 'ray' }\n",
                  by_half_spaces = "contact = { distance = 0.01 }\n";

std::vector<solver::Contact> contacts_of(const std::string& rule, const std::string& obstacle, const solver::State& y) {
  const Trial trial = particles(rule + "obstacles = [{ " + obstacle + " }]\n");
  std::vector<solver::Contact> found;
  trial.cloth.contacts->find(0.2, 0.01, y, found);
  return found;
}

/// Particles that move so slowly that none leaves the neighbourhood of a face.
TEST(Rays, FindTheHalfSpacesOfAConvexBody) {
  const std::string box =
      "shape = 'box', size = [2, 2, 1], friction = 0.3, motion = [{ time = 0, rotation = [0, 0, 10] }, { time = 1, position = "
      "[0.1, 0, 0.2], rotation = [0, 0, 30] }]";
  solver::State y;
  y.x.resize(4, 3), y.v.resize(4, 3);
  y.x << 0, 0, 0.555, 0.3, 0.2, 0.545, 0.3, 0.3, 0.5525, -0.3, 0.1, 0.9;
  y.v << 0.1, 0, -0.5, 0.05, 0.1, 0.2, 0, 0, 0, 0, 0, -0.5;
  const auto rays = contacts_of(by_rays, box, y), half_spaces = contacts_of(by_half_spaces, box, y);
  ASSERT_EQ(rays.size(), 3u);  // the last is too high
  ASSERT_GE(half_spaces.size(), rays.size());
  for (const solver::Contact& ray : rays) {
    const auto same = std::ranges::find(half_spaces, ray.particle, &solver::Contact::particle);
    ASSERT_NE(same, half_spaces.end());
    EXPECT_NEAR(ray.gap, same->gap, 1e-12);
    EXPECT_NEAR(ray.least, same->least, 1e-12);
    EXPECT_LE((ray.normal - same->normal).norm(), 1e-12);
    EXPECT_EQ(ray.friction, same->friction);
    EXPECT_EQ(ray.obstacle, same->obstacle);
  }
  EXPECT_LE((rays[1].velocity - half_spaces[1].velocity).norm(), 1e-9);  // it is inside at once: the same point of the border
}

TEST(Rays, FindWhatHasSunkIn) {
  solver::State y;
  y.x.resize(2, 3), y.v.setZero(2, 3);
  y.x << 0, 0, 0.497, 0, 0, 0.3;  // 13 mm in the collision area, and out of the reach of rays
  const auto found = contacts_of(by_rays, "shape = 'box', size = [2, 2, 1]", y);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].gap, -0.013, 1e-12);
  EXPECT_LE((found[0].normal - Vector3d::UnitZ()).norm(), 1e-12);
}

/// It falls along a wall, on which no way of its own would find it.
TEST(Rays, FindWhatStandsOnTheBorder) {
  solver::State y;
  y.x.resize(1, 3), y.v.resize(1, 3);
  y.x << 1.01 + 1e-9, 0, 0;
  y.v << 0, 0, -1;
  const auto found = contacts_of(by_rays, "shape = 'box', size = [2, 2, 1]", y);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].gap, 1e-9, 1e-12);
  EXPECT_LE((found[0].normal - Vector3d::UnitX()).norm(), 1e-12);
}

/// Heights of four particles over a plate of 1 mm at z = −0.2 after they were shot at it with 50 m/s, half a meter a step.
Eigen::VectorXd heights_over_plate(const std::string& contact, const std::string& method) {
  const Trial trial = particles(contact +
                                "start.velocity = [0, 0, -50]\nend.time = 0.05\n"
                                "obstacles = [{ shape = 'box', size = [1, 1, 0.001], position = [0, 0, -0.2] }]\n");
  return run(trial, method, 0.01).back().y.x.col(2).array() + 0.2;
}

TEST(Rays, CatchWhatFliesThroughAThinBodyInAStep) {
  for (const char* response : {"reposition", "reflect", "impulse"}) {
    const std::string contact = fmt::format("contact = {{ distance = 1e-3, response = '{}'", response);
    EXPECT_GE(heights_over_plate(contact + ", detection = 'ray' }\n", "bdf2").minCoeff(), 1.5e-3 - 1e-9) << response;
    EXPECT_LT(heights_over_plate(contact + " }\n", "bdf2").maxCoeff(), -1) << response;  // not seen
  }
  for (const std::string& method : methods())
    EXPECT_GE(heights_over_plate("contact = { distance = 1e-3, detection = 'ray' }\n", method).minCoeff(), 1.5e-3 - 1e-6)
        << method;
}

TEST(Rays, KeepParticlesAtRestOnTheBorder) {
  const std::string scene = "end.time = 0.5\nobstacles = [{ shape = 'box', size = [1, 1, 0.1], position = [0, 0, -0.07] }]\n";
  for (const std::string& method : methods()) {
    const Trial trial = particles(by_rays + scene);
    const auto moments = run(trial, method, 0.01);
    EXPECT_LE((moments.back().y.x.col(2).array() + 0.01).abs().maxCoeff(), 1e-6) << method;
    EXPECT_EQ(moments.back().contacts.constrained, 4) << method;
  }
}

// --- What rays cannot serve --------------------------------------------------------------------------------------------------

std::string refusal(const std::string& obstacle, model::ResponseKind response = model::ResponseKind::constraint) {
  const std::vector<model::ObstacleRule> obstacles{verify::obstacle("shape = 'sphere', radius = 1"),
                                                   verify::obstacle(obstacle)};
  model::ContactRule rule;
  rule.response = response;
  rule.detection = model::DetectionKind::ray;
  try {
    model::met_parts(obstacles, rule);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Rays, RefuseWhatTheyCannotServe) {
  const base::TemporaryFolder folder;
  write_mesh(folder / "small.ply", box_mesh({1, 1, 1}));
  write_mesh(folder / "large.ply", box_mesh({2, 2, 2}));
  const std::string small = (folder / "small.ply").string(), large = (folder / "large.ply").string();
  const std::string deforms = fmt::format(
      "shape = 'mesh', file = '{0}', frames = [{{ time = 0, file = '{0}' }}, {{ time = 1, file = '{1}' }}]", small, large);
  EXPECT_EQ(refusal("shape = 'plane'"),
            "contact.detection: expected \"half-spaces\" with obstacles[1] (plane): its surface: expected a closed mesh, "
            "4 edges of its 2 triangles are open");
  EXPECT_EQ(refusal(deforms),
            "contact.detection: expected \"half-spaces\" with obstacles[1] (mesh): expected a rigid body, it deforms");
  for (const auto response : {model::ResponseKind::penalty, model::ResponseKind::field, model::ResponseKind::reaction,
                              model::ResponseKind::alteration})
    EXPECT_THAT(refusal("shape = 'mannequin'", response), HasSubstr("contact.detection: expected \"half-spaces\", "));
  EXPECT_EQ(refusal("shape = 'mannequin', walk = 1"), "");
  EXPECT_EQ(refusal(fmt::format("shape = 'mesh', file = '{}'", small)), "");
}

}  // namespace
}  // namespace drape::verify::detection_test
