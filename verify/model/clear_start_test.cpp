// Scenes whose cloth begins inside an obstacle, or is pulled through one, are refused with the worst place.

#include "model/clear_start.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>

#include "model/scene_file/scene_file.hpp"
#include "verify/support/contact_scenes.hpp"
#include "verify/support/mesh_files.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::clear_start_test {
namespace {

using model::TriangleMesh;
using testing::HasSubstr;
using testing::StartsWith;

/// A horizontal sheet at height 0 with corners at 0 and 0.3 m, edges of 0.1 m.
const std::string one_sheet =
    "name = 'sheet'\nmaterial = {tension = 50, damping = 0.5, density = 0.2}\ngrid = {n = 4, size = 0.3}\n"
    "contact.distance = 0.01\n";

/// Two upright squares of 0.4 m at y = -0.2 and 0.2.
const std::string front_and_back =
    "name = 'two'\nmaterial = {tension = 50, density = 0.2}\nstart.plane = 'vertical'\ncontact.distance = 0.01\n"
    "panels = [{name = 'front', grid.n = 5, grid.size = 0.4, start.position = [0, -0.2, 0]}, "
    "{name = 'back', grid.n = 5, grid.size = 0.4, start.position = [0, 0.2, 0]}]\n";

/// The right sides are pulled together within 0.4 s: along y, to x = 0.4, y = 0.
const std::string pulled = front_and_back +
                           "seams = [{one = {panel = 'front', side = 'right'}, other = {panel = 'back', side = 'right'}}]\n"
                           "phases = [{until = 0.4, seams = 'pulled'}]\n";

/// What is said of a scene; "" if nothing is wrong.
std::string refusal(const std::string& toml) {
  try {
    model::require_clear_start(model::parse_scene(toml, "a.toml"));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string with(const std::string& scene, const std::string& obstacle) { return scene + "obstacles = [{" + obstacle + "}]\n"; }

std::string ball(double radius, double x, double y, double z) {
  return fmt::format("shape = 'sphere', radius = {}, position = [{}, {}, {}]", radius, x, y, z);
}

/// An upright cylinder of 0.1 m.
std::string upright_rod(double radius, double x, double y) {
  return fmt::format("shape = 'cylinder', radius = {}, height = 0.1, position = [{}, {}, 0]", radius, x, y);
}

TEST(ClearStart, IsThatOfAllBuiltinScenes) {
  for (const model::BuiltinScene& builtin : model::builtin_scenes())
    EXPECT_NO_THROW(model::require_clear_start(model::load_scene(std::string(builtin.name)))) << builtin.name;
}

TEST(ClearStart, MayBeInsideByTheContactDistance) {
  EXPECT_EQ(refusal(with(one_sheet, "shape = 'plane', position = [0, 0, 0.0099]")), "");
  EXPECT_EQ(
      refusal(with(one_sheet, "shape = 'plane', position = [0, 0, 0.05]")),
      "expected particle [0, 0] to begin at most contact.distance = 0.01 m inside obstacles[0] (plane), not 0.05 m at t = "
      "0 s");
  EXPECT_EQ(refusal(with(one_sheet, ball(0.05, 0.2, 0.1, -0.0402))), "") << "0.0098 m below the top";
  EXPECT_EQ(
      refusal(with(one_sheet, "shape = 'plane', position = [0, 0, -1]}, {" + ball(0.05, 0.2, 0.1, -0.03))),
      "expected particle [2, 1] to begin at most contact.distance = 0.01 m inside obstacles[1] (sphere), not 0.02 m at t = "
      "0 s");
}

TEST(ClearStart, IsSeenBetweenParticles) {
  const std::string edge = "expected the edge from [1, 1] to [2, 1] not to pass through ";
  EXPECT_EQ(refusal(with(one_sheet, ball(0.02, 0.15, 0.1, 0))), edge + "obstacles[0] (sphere), 0.02 m deep at t = 0 s");
  EXPECT_THAT(refusal(with(one_sheet, upright_rod(0.002, 0.143, 0.1))), StartsWith(edge + "obstacles[0] (cylinder), 0.00"));
  EXPECT_EQ(refusal(with(one_sheet, ball(0.02, 0.15, 0.15, 0))),
            "expected the diagonal from [1, 1] to [2, 2] not to pass through obstacles[0] (sphere), 0.02 m deep at t = 0 s");
  EXPECT_EQ(
      refusal(with(one_sheet, ball(0.04, 0.15, 0.1, -0.028))),
      "expected the edge from [1, 1] to [2, 1] to begin at most contact.distance = 0.01 m inside obstacles[0] (sphere), not "
      "0.012 m at t = 0 s");
  EXPECT_EQ(refusal(with("name = 'chain'\ngrid = {n = [4, 1], size = [0.3, 0.1]}\ncontact.distance = 0.01\n",
                         ball(0.004, 0.15, 0, 0))),
            "expected the edge from [1, 0] to [2, 0] not to pass through obstacles[0] (sphere), 0.004 m deep at t = 0 s");
}

TEST(ClearStart, IsSearchedForTheDeepestPlace) {
  EXPECT_EQ(refusal(with(one_sheet, ball(0.12, 0.13, 0.1, 0))),
            "expected the edge from [1, 1] to [2, 1] not to pass through obstacles[0] (sphere), 0.12 m deep at t = 0 s");
}

/// With pieces as short as the contact distance this would take hours.
TEST(ClearStart, IsSeenQuicklyWhereClothLiesOnAnObstacle) {
  EXPECT_EQ(refusal("name = 'lying'\ngrid.n = 20\ncontact.distance = 1e-9\nobstacles = [{shape = 'plane'}]\n"), "");
}

/// Obstacles that push both ends of an edge to the same side.
TEST(ClearStart, MayTouchRodsAndEdges) {
  const auto lying_rod = [](double z) {
    return fmt::format("shape = 'cylinder', radius = 0.004, height = 1, position = [0.15, 0, {}], rotation = [90, 0, 0]", z);
  };
  EXPECT_EQ(refusal(with(one_sheet, lying_rod(-0.003))), "");
  EXPECT_THAT(refusal(with(one_sheet, lying_rod(0))),
              StartsWith("expected the edge from [1, 0] to [2, 0] not to pass through"));
  const auto wedge = [](double top) {
    return fmt::format("shape = 'box', size = [0.2, 1, 0.2], position = [0.15, 0, {}], rotation = [0, 45, 0]",
                       top - 0.1 * std::numbers::sqrt2);
  };
  EXPECT_EQ(refusal(with(one_sheet, wedge(0.004))), "");
  EXPECT_THAT(refusal(with(one_sheet, wedge(0.02))), HasSubstr("inside obstacles[0] (box), not 0.0141 m at t = 0 s"));
}

/// Two bars under the middle of the sheet, whose upper edges come through it by 2 mm: what is outermost of each is steep, and
/// its other side flat.
TriangleMesh two_bars() {
  const TriangleMesh bar = box_mesh({0.015, 0.4, 0.02});
  const Eigen::Vector3d corner(-0.0075, 0, 0.01);
  const Eigen::AngleAxisd turn(0.3, Eigen::Vector3d::UnitY());
  TriangleMesh both{"", {}, bar.triangles};
  for (const Eigen::Vector3d& v : bar.vertices)
    both.vertices.emplace_back(Eigen::Vector3d(-0.02, 0, 0.002) + turn * (v - corner));
  const int first = static_cast<int>(bar.vertices.size());
  for (int k = 0; k < first; ++k)
    both.vertices.emplace_back(both.vertices[static_cast<std::size_t>(k)].cwiseProduct(Eigen::Vector3d(-1, 1, 1)));
  for (const auto& [a, b, c] : bar.triangles) both.triangles.push_back({first + a, first + c, first + b});
  return both;
}

TEST(ClearStart, MayTouchTwoEdgesOfOneObstacle) {
  const base::TemporaryFolder folder;
  const std::string file = folder / "bars.ply";
  write_mesh(file, two_bars());
  EXPECT_EQ(refusal(with(one_sheet, "shape = 'mesh', file = '" + file + "', position = [0.15, 0.15, 0]")), "");
  EXPECT_THAT(refusal(with(one_sheet, "shape = 'mesh', file = '" + file + "', position = [0.15, 0.15, 0.008]")),
              HasSubstr("to pass through obstacles[0] (mesh), 0.00"));
}

TEST(ClearStart, MayHaveABodyBetweenPanels) {
  EXPECT_EQ(refusal(with(front_and_back, ball(0.15, 0.2, 0, 0.2))), "");
  EXPECT_EQ(
      refusal(with(front_and_back, ball(0.15, 0.2, 0.1, 0.2))),
      "panel 'back': expected particle [2, 2] to begin at most contact.distance = 0.01 m inside obstacles[0] (sphere), not "
      "0.05 m at t = 0 s");
}

/// What is pinned in all directions does not meet obstacles: cloth may be held by a clamp.
TEST(ClearStart, MayBeHeldInside) {
  const std::string clamped = with(one_sheet, "shape = 'box', size = [0.05, 0.5, 0.2], position = [0, 0.15, 0]");
  EXPECT_EQ(refusal(clamped + "pins = [{where = 'left edge'}]\n"), "");
  for (const char* pins : {"", "pins = [{where = 'left edge', directions = 'xy'}]\n"})
    EXPECT_THAT(refusal(clamped + pins), HasSubstr("inside obstacles[0] (box), not 0.025 m"));
}

TEST(ClearStart, IsThatOfObstaclesAtTheStart) {
  const auto moving = [](double from, double to) {
    return with(one_sheet, fmt::format("shape = 'sphere', radius = 0.05, motion = [{{time = {}, position = [0.1, 0.1, 1]}}, "
                                       "{{time = {}, position = [0.1, 0.1, 0]}}]",
                                       from, to));
  };
  EXPECT_EQ(refusal(moving(0, 1)), "");
  EXPECT_THAT(refusal(moving(-1, 0)), HasSubstr("0.05 m"));
  const base::TemporaryFolder folder;
  const std::string low = folder / "low.ply", high = folder / "high.ply";
  write_mesh(low, box_mesh({0.25, 0.25, 0.125}));
  write_mesh(high, box_mesh({0.25, 0.25, 0.25}));
  const auto growing = [&](double from, double to) {
    return with(one_sheet,
                fmt::format("shape = 'mesh', file = '{0}', position = [0.15, 0.15, -0.0725], frames = [{{time = {2}, "
                            "file = '{0}'}}, {{time = {3}, file = '{1}'}}]",
                            low, high, from, to));
  };
  EXPECT_EQ(refusal(growing(0, 1)), "");
  EXPECT_THAT(refusal(growing(-1, 0)), HasSubstr("inside obstacles[0] (mesh), not 0.0525 m at t = 0 s"));
}

TEST(ClearStart, IsFollowedByWaysOfSeamsOutside) {
  const std::string begin = "seams[0]: expected particle [4, 2] on front right to be pulled at most contact.distance = 0.01 m ";
  EXPECT_EQ(refusal(with(pulled, ball(0.05, 0.2, 0, 0.2))), "");
  EXPECT_THAT(refusal(with(pulled, ball(0.05, 0.4, -0.2, 0.2))),
              StartsWith("panel 'front': expected particle [4, 2] to begin"));
  EXPECT_EQ(refusal(with(pulled, ball(0.05, 0.4, 0, 0.2))), begin + "inside obstacles[0] (sphere), not 0.05 m at t = 0.4 s");
  EXPECT_EQ(refusal(with(pulled, ball(0.05, 0.4, -0.1, 0.2))), begin + "inside obstacles[0] (sphere), not 0.05 m at t = 0.2 s");
  EXPECT_EQ(
      refusal(with(pulled, ball(0.05, 0.41, 0.1, 0.4))),
      "seams[0]: expected particle [4, 4] on back right to be pulled at most contact.distance = 0.01 m inside obstacles[0] "
      "(sphere), not 0.04 m at t = 0.2 s");
  EXPECT_EQ(
      refusal(with(pulled, ball(0.009, 0.4, -0.1, 0.15))),
      "seams[0]: expected the edge from [4, 1] to [4, 2] on front right not to pass through obstacles[0] (sphere), 0.009 m "
      "deep at t = 0.2 s");
  EXPECT_THAT(refusal(with(pulled, ball(0.009, 0.4, -0.1, 0.202))), HasSubstr("the edge from [4, 2] to [4, 3]"));
  EXPECT_EQ(refusal(with(front_and_back, ball(0.05, 0.4, -0.1, 0.2))), "") << "no seams";
  const std::string turning =
      pulled +
      "pins = [{where = 'left edge', panel = 'front', path = [{time = 0, position = [0, 0, 0]}, {time = 0.1, position = "
      "[0, 0, 0.01]}]}]\n";
  EXPECT_EQ(refusal(with(turning, ball(0.05, 0.4, -0.1, 0.2))), begin + "inside obstacles[0] (sphere), not 0.05 m at t = 0.2 s")
      << "after a pin has turned";
  EXPECT_EQ(refusal(with("end.time = 0.1\n" + pulled, ball(0.05, 0.4, -0.1, 0.2))), "") << "the scene ends before";
}

TEST(ClearStart, IsFollowedByWaysOfSeamsOutsideOfWhatMoves) {
  const auto crossing = [](double passes) {
    return with(pulled, fmt::format("shape = 'sphere', radius = 0.05, motion = [{{time = {}, position = [0.4, -0.1, 0.6]}}, "
                                    "{{time = {}, position = [0.4, -0.1, -0.2]}}]",
                                    passes - 0.2, passes + 0.2));
  };
  EXPECT_THAT(refusal(crossing(0.2)), HasSubstr("inside obstacles[0] (sphere), not 0.05 m at t = 0.2 s"));
  EXPECT_EQ(refusal(crossing(1)), "");
}

/// The particle at the tip of a dart meets itself.
TEST(ClearStart, KnowsDarts) {
  EXPECT_EQ(refusal(with("name = 'dart'\npanels = [{name = 'a', grid.n = 6, grid.size = 0.5}]\n"
                         "seams = [{one = {panel = 'a', side = 'upper', ends = [3, 2]}, "
                         "other = {panel = 'a', side = 'upper', ends = [1, 2]}}]\n"
                         "phases = [{until = 0.4, seams = 'pulled'}]\n",
                         ball(0.1, 0.2, 0.2, -0.2))),
            "");
}

/// What is let pass is put right by all responses.
TEST(ClearStart, IsLeftForThePlaceOutside) {
  for (const char* response : {"constraint", "reaction"})
    for (const std::string& obstacle :
         {std::string("shape = 'plane', position = [0, 0, 0.0099]"), ball(0.05, 0.2, 0.1, -0.0402)}) {
      const contact_scenes::Trial trial = contact_scenes::sheet(
          fmt::format("contact.distance = 0.01\ncontact.response = '{}'\nobstacles = [{{{}}}]\n", response, obstacle));
      ASSERT_NO_THROW(model::require_clear_start(trial.scene));
      const auto moments = contact_scenes::run(trial, "sbdf2", 0.01);
      EXPECT_GE(trial.cloth.contacts->distances(moments.back().t, moments.back().y.x).minCoeff(), 0) << response << obstacle;
    }
}

}  // namespace
}  // namespace drape::verify::clear_start_test
