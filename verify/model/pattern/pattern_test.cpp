// Sewing patterns of GarmentCode: their curves, the grids that fill them, and the seams between these.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <numbers>
#include <string>

#include "model/garment.hpp"
#include "model/pattern/sewn_pattern.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/pattern_files.hpp"

namespace drape::verify::pattern_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using model::Curve;
using model::Garment;
using model::PanelSide;
using model::SewingPattern;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double rounding = 1e-12;

const std::string square = "[[0, 0], [100, 0], [100, 100], [0, 100]]";
const std::string around = R"({"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]})";

std::string panel(const std::string& vertices, const std::string& edges, const std::string& translation = "[0, 0, 0]",
                  const std::string& rotation = "[0, 0, 0]") {
  return fmt::format(R"({{"vertices": {}, "edges": [{}], "translation": {}, "rotation": {}}})", vertices, edges, translation,
                     rotation);
}

std::string stitch(const std::string& one, int edge, const std::string& other, int other_edge) {
  return fmt::format(R"([{{"panel": "{}", "edge": {}}}, {{"panel": "{}", "edge": {}}}])", one, edge, other, other_edge);
}

std::string json(const std::string& panels, const std::string& stitches = "") {
  return fmt::format(R"({{"pattern": {{"panels": {{{}}}, "stitches": [{}]}}, "properties": {{"units_in_meter": 100}}}})",
                     panels, stitches);
}

SewingPattern read(const std::string& text) { return pattern_of("shirt.json", text); }

/// A panel of one square with this edge in the place of the lower one.
Curve lower_edge(const std::string& curvature) {
  const std::string edges = R"({"endpoints": [0, 1], "curvature": )" + curvature +
                            R"(}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]})";
  return Curve({read(json("\"a\": " + panel(square, edges))).panels.at(0).edges.at(0).curve});
}

void expect_near(const Eigen::VectorXd& point, const Eigen::VectorXd& expected, double within = rounding) {
  EXPECT_LE((point - expected).norm(), within) << point.transpose() << " instead of " << expected.transpose();
}

TEST(Pattern, EdgesAreCurvesInTheirFrame) {
  const Curve quadratic = lower_edge(R"({"type": "quadratic", "params": [[0.5, 0.4]]})");
  expect_near(quadratic.at(0.5), Vector2d(0.5, 0.2));
  const Curve as_list = lower_edge("[0.5, 0.4]");
  expect_near(as_list.at(0.5), Vector2d(0.5, 0.2));
  const Curve cubic = lower_edge(R"({"type": "cubic", "params": [[0.25, -0.2], [0.75, -0.2]]})");
  expect_near(cubic.at(0.5), Vector2d(0.5, -0.15));
  const Curve left = lower_edge(R"({"type": "circle", "params": [50, 0, 0]})");
  expect_near(left.at(0.5), Vector2d(0.5, 0.5));
  const Curve right = lower_edge(R"({"type": "circle", "params": [50, 0, 1]})");
  expect_near(right.at(0.5), Vector2d(0.5, -0.5));
  const double radius = 0.5 / std::sin(std::numbers::pi / 3);
  const Curve small = lower_edge(fmt::format(R"({{"type": "circle", "params": [{:.17g}, 0, 1]}})", 100 * radius));
  EXPECT_NEAR(small.length(), radius * 2 * std::numbers::pi / 3, rounding);
  const Curve large = lower_edge(fmt::format(R"({{"type": "circle", "params": [{:.17g}, 1, 1]}})", 100 * radius));
  EXPECT_NEAR(large.length(), radius * 4 * std::numbers::pi / 3, rounding);
}

/// What goes round clockwise is filled as what goes round the other way.
TEST(Pattern, PanelsAreFilledHoweverTheyGoRound) {
  const std::string backwards = R"({"endpoints": [0, 3]}, {"endpoints": [3, 2]}, {"endpoints": [2, 1]}, {"endpoints": [1, 0]})";
  const auto one = model::sew(read(json("\"a\": " + panel(square, around))), 0.1).scene;
  const auto other = model::sew(read(json("\"a\": " + panel(square, backwards))), 0.1).scene;
  EXPECT_TRUE(one.panels.empty()) << "one piece is a sheet";
  const model::Grid& grid = one.sheet.grid;
  EXPECT_EQ(grid.nu, 11);
  EXPECT_EQ(grid.nv, 11);
  expect_near(grid.parameters().row(grid.index(3, 2)).transpose(), Vector3d(0.3, 0.2, 0));
  EXPECT_EQ(grid.parameters(), other.sheet.grid.parameters());
}

/// y of a pattern points up, z towards the viewer, who stands at −y.
TEST(Pattern, PanelsAreWhereTheyArePlaced) {
  const auto corner = [](const std::string& rotation, int a, int b) -> Vector3d {
    const auto scene = model::sew(read(json("\"a\": " + panel(square, around, "[10, 20, 30]", rotation))), 0.5).scene;
    return Garment(scene).start().x.row(scene.sheet.grid.index(a, b));
  };
  expect_near(corner("[0, 0, 0]", 0, 0), Vector3d(0.1, -0.3, 0.2));
  expect_near(corner("[0, 0, 0]", 2, 0), Vector3d(1.1, -0.3, 0.2));
  expect_near(corner("[0, 0, 0]", 0, 2), Vector3d(0.1, -0.3, 1.2));
  expect_near(corner("[0, 90, 0]", 2, 0), Vector3d(0.1, 0.7, 0.2));
  expect_near(corner("[0, 0, 90]", 2, 0), Vector3d(0.1, -0.3, 1.2));
  expect_near(corner("[90, 0, 0]", 0, 2), Vector3d(0.1, -1.3, 0.2));
  expect_near(corner("[90, 0, 90]", 2, 0), Vector3d(0.1, -1.3, 0.2));  // about its own axes, x first
}

/// A skirt of a front and a back: as many particles on sewn edges, cells near the wished length, and those ends meet that are
/// nearer.
TEST(Pattern, SeamsJoinEqualNumbersOfParticles) {
  const std::string wide = "[[-60, 0], [60, 0], [30, 70], [-30, 70]]", narrow = "[[-50, 0], [50, 0], [28, 66], [-28, 66]]";
  const SewingPattern pattern = read(json(fmt::format("\"front\": {}, \"back\": {}", panel(wide, around, "[0, 50, 25]"),
                                                      panel(narrow, around, "[0, 50, -25]", "[0, 180, 0]")),
                                          stitch("front", 1, "back", 3) + ", " + stitch("back", 1, "front", 3)));
  const model::SewnPattern sewn = model::sew(pattern, 0.05);
  const model::Scene& scene = sewn.scene;
  ASSERT_EQ(scene.panels.size(), 2);
  const model::Grid &front = scene.panels[0].grid, &back = scene.panels[1].grid;
  EXPECT_EQ(scene.panels[0].name, "front");
  EXPECT_EQ(front.nv, back.nv);
  EXPECT_NEAR(front.nv, 0.74 / 0.05 + 1, 1.5);
  EXPECT_NEAR(front.nu, (1.2 + 0.6) / 2 / 0.05 + 1, 1.5);
  ASSERT_EQ(scene.seams.size(), 2);
  EXPECT_EQ(scene.seams[0].one.side, PanelSide::right);
  EXPECT_EQ(scene.seams[0].other.side, PanelSide::left);
  EXPECT_THAT(scene.seams[0].one.ends, ElementsAre(0, front.nv - 1));
  EXPECT_THAT(scene.seams[0].other.ends, ElementsAre(0, front.nv - 1));
  EXPECT_THAT(sewn.remarks.at(0), HasSubstr("front edge 1 with back edge 3: ends 1.01 m away, the other way round 1.77 m"));
  EXPECT_THAT(sewn.remarks.at(0), HasSubstr("% are gathered"));
  EXPECT_EQ(Garment(scene).nodes(), Garment(scene).particles() - 2 * front.nv);
  ASSERT_EQ(scene.phases.size(), 1);
  EXPECT_EQ(scene.phases[0].seams, model::SeamState::pulled);
  EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "again")), to_toml(scene));
}

/// The right edges show clearly which faces are outside; by ways alone the other seam would turn one of them inside out.
TEST(Pattern, SeamsInDoubtFollowTheFaces) {
  const model::SewnPattern sewn = model::sew(
      read(json(
          fmt::format("\"front\": {}, \"back\": {}", panel(square, around, "[0, 0, 25]"), panel(square, around, "[0, 0, -25]")),
          stitch("front", 0, "back", 3) + ", " + stitch("front", 1, "back", 1))),
      0.1);
  const auto& seams = sewn.scene.seams;
  ASSERT_EQ(seams.size(), 2);
  EXPECT_THAT(seams[0].one.ends, ElementsAre(0, 10));
  EXPECT_EQ(seams[0].other.side, PanelSide::left);
  EXPECT_THAT(seams[0].other.ends, ElementsAre(10, 0));
  EXPECT_THAT(seams[1].one.ends, ElementsAre(0, 10));
  EXPECT_THAT(seams[1].other.ends, ElementsAre(0, 10));
  EXPECT_THAT(sewn.remarks[0], HasSubstr("sewn so that no panel is inside out"));
}

/// The edges of a dart are sewn to each other, and its ends no corners, although angles there are nearer to right ones than
/// those of the roof in which it is.
TEST(Pattern, DartsAreNoCorners) {
  const std::string vertices = "[[0, 0], [100, 0], [100, 80], [55, 100], [50, 60], [45, 100], [0, 80]]";
  std::string edges;
  for (int k = 0; k < 7; ++k) edges += fmt::format(R"({}{{"endpoints": [{}, {}]}})", k > 0 ? ", " : "", k, (k + 1) % 7);
  const model::Scene scene = model::sew(read(json("\"a\": " + panel(vertices, edges), stitch("a", 3, "a", 4))), 0.1).scene;
  const model::Grid& grid = scene.panels.at(0).grid;
  const auto place = [&](int a, int b) -> Vector2d { return grid.parameters().row(grid.index(a, b)).head<2>(); };
  expect_near(place(0, 0), Vector2d(0, 0));
  expect_near(place(grid.nu - 1, grid.nv - 1), Vector2d(1, 0.8));
  const std::vector<int>& ends = scene.seams.at(0).one.ends;
  EXPECT_EQ(scene.seams[0].one.side, PanelSide::upper);
  ASSERT_EQ(ends.size(), 2);
  expect_near(place(ends[0], grid.nv - 1), Vector2d(0.55, 1));
  expect_near(place(ends[1], grid.nv - 1), Vector2d(0.5, 0.6));
  expect_near(place(scene.seams[0].other.ends[0], grid.nv - 1), Vector2d(0.45, 1));
  expect_near(place(scene.seams[0].other.ends[1], grid.nv - 1), Vector2d(0.5, 0.6));
  EXPECT_EQ(Garment(scene).nodes(), grid.particles() - std::abs(ends[1] - ends[0]));
}

TEST(Pattern, WhatIsWrongIsSaidInOneLine) {
  const auto message = [](const std::string& text) { return pattern_error("shirt.json", text); };
  const auto of_edges = [&](const std::string& edges) { return message(json("\"a\": " + panel(square, edges))); };
  const std::string good = "\"a\": " + panel(square, around), begin = R"({"endpoints": [0, 1]}, )";
  EXPECT_EQ(message(json(good)), "no error");
  EXPECT_THAT(message("{"), HasSubstr("shirt.json: expected the JSON of a pattern of GarmentCode"));
  EXPECT_THAT(message("{}"), HasSubstr("shirt.json: expected the key \"pattern\""));
  EXPECT_THAT(message(R"({"pattern": {"panels": []}})"), HasSubstr("panels: expected an object of 1 to 1000 panels"));
  EXPECT_THAT(of_edges(begin + R"({"endpoints": [2, 3]})"),
              HasSubstr("panel a: edge 1: begins at vertex 2, the one before ends at 1: expected a closed outline"));
  EXPECT_THAT(of_edges(begin + R"({"endpoints": [1, 2]}, {"endpoints": [2, 3]})"),
              HasSubstr("panel a: edge 2 ends at vertex 3, edge 0 begins at 0: expected a closed outline"));
  EXPECT_THAT(of_edges(begin + R"({"endpoints": [1, 3]}, {"endpoints": [3, 2]}, {"endpoints": [2, 0]})"),
              HasSubstr("panel a: edges 1 and 3 cross: expected an outline that does not cross itself"));
  EXPECT_THAT(of_edges(begin + R"({"endpoints": [1, 4]})"),
              HasSubstr("panel a: edge 1: endpoints: expected a number from 0 to 3"));
  EXPECT_THAT(of_edges(begin + R"({"endpoints": [1, 2]}, {"endpoints": [2, 0]})"),
              HasSubstr("panel a: expected four corners beside darts, so that it can be filled with quadrilaterals, not 3"));
  EXPECT_THAT(of_edges(R"({"endpoints": [0, 1], "curvature": {"type": "spiral", "params": []}}, {})"),
              HasSubstr("panel a: edge 0: curvature: type: expected \"quadratic\", \"cubic\" or \"circle\""));
  EXPECT_THAT(of_edges(R"({"endpoints": [0, 1], "curvature": {"type": "circle", "params": [20, 0, 0]}}, {})"),
              HasSubstr("panel a: edge 0: curvature: params: expected a radius of at least 50, half of the edge"));
  EXPECT_THAT(message(json("\"a\": " + panel("[[0, 0], [1, \"x\"]]", around))),
              HasSubstr("panel a: vertices: expected numbers"));
  EXPECT_THAT(message(json(good, stitch("a", 0, "b", 1))), HasSubstr("stitch 0: panel: there is no panel \"b\""));
  EXPECT_THAT(message(json(good, stitch("a", 0, "a", 4))), HasSubstr("stitch 0: edge: expected a number from 0 to 3"));
  EXPECT_THAT(message(json(good, stitch("a", 2, "a", 2))), HasSubstr("stitch 0: expected two edges, not one with itself"));
  // Its lower edge has as many cells as a part of its upper one.
  const std::string five =
      R"({"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 4]}, {"endpoints": [4, 0]})";
  EXPECT_THAT(
      message(json("\"a\": " + panel("[[0, 0], [100, 0], [100, 100], [50, 100], [0, 100]]", five), stitch("a", 0, "a", 2))),
      HasSubstr("expected seams that allow grids with as many cells on opposite sides of every panel"));
}

}  // namespace
}  // namespace drape::verify::pattern_test
