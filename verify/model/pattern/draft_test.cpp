// Patterns as curves in mm: outlines of named edges, stretches of them that are sewn, and the patterns that are kept.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <numbers>
#include <string>

#include "model/cloth.hpp"
#include "model/keys/scene_error.hpp"
#include "model/pattern/sewn_pattern.hpp"
#include "model/scene_file/scene_file.hpp"
#include "verify/support/pattern_files.hpp"

namespace drape::verify::draft_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using model::Curve;
using model::SewingPattern;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double rounding = 1e-12;

SewingPattern read(const std::string& text) { return pattern_of("skirt.toml", text); }

/// A square of 400 mm, whose right side may be other edges.
std::string panel(const std::string& name, const std::string& right, const std::string& more = "") {
  return fmt::format(R"(
[[panels]]
name = "{}"
points = {{ a = [0, 0], b = [400, 0], c = [400, 400], d = [0, 400] }}
outline = [
  {{ line = ["a", "b"], name = "hem" }},
  {},
  {{ line = ["c", "d"], name = "waist" }},
  {{ line = ["d", "a"], name = "left" }},
]
{}
)",
                     name, right, more);
}

const std::string straight = R"({ line = ["b", "c"], name = "right" })";

/// The same going round clockwise.
std::string mirrored(const std::string& name) {
  return fmt::format(R"(
[[panels]]
name = "{}"
outline = [
  {{ line = [[0, 0], [0, 400]], name = "left" }},
  {{ line = [[0, 400], [400, 400]], name = "waist" }},
  {{ line = [[400, 400], [400, 0]], name = "right" }},
  {{ line = [[400, 0], [0, 0]], name = "hem" }},
]
)",
                     name);
}

std::string stitch(const std::string& one, const std::string& other, const std::string& more = "") {
  return fmt::format("[[stitches]]\none = {{ {} }}\nother = {{ {} }}\n{}\n", one, other, more);
}

void expect_near(const Eigen::VectorXd& point, const Eigen::VectorXd& expected, double within = rounding) {
  EXPECT_LE((point - expected).norm(), within) << point.transpose() << " instead of " << expected.transpose();
}

TEST(Draft, IsInMillimetresBetweenPointsThatHaveNames) {
  const SewingPattern pattern = read("name = 'half'\n" + panel("front", R"({ arc = ["b", [600, 200], "c"] })",
                                                               "position = [10, 20, 30]\nrotation = [0, 0, 90]"));
  EXPECT_EQ(pattern.name, "half");
  ASSERT_EQ(pattern.panels.size(), 1);
  const model::PatternPanel& front = pattern.panels[0];
  EXPECT_EQ(front.name, "front");
  ASSERT_EQ(front.edges.size(), 4);
  EXPECT_EQ(front.edges[0].name, "hem");
  EXPECT_EQ(front.edges[1].name, "1");
  EXPECT_NEAR(Curve({front.edges[1].curve}).length(), 0.2 * std::numbers::pi, rounding);
  expect_near(front.edges[2].curve.points[0], Vector2d(0.4, 0.4));
  expect_near(front.position, Vector3d(0.01, 0.02, 0.03));
  expect_near(front.rotation * Vector3d(1, 0, 0), Vector3d(0, 1, 0));
}

/// Beginnings meet, in whichever direction outlines are drawn.
TEST(Draft, JoinsTheBeginningsOfStretches) {
  const auto side_by_side = [](const std::string& other, const std::string& backwards) {
    const SewingPattern pattern = read(panel("front", straight) + other +
                                       stitch("panel = 'front', edge = 'right'", "panel = 'back', edge = 'right'" + backwards));
    EXPECT_EQ(pattern.stitches.size(), 1);
    const model::Stitch& only = pattern.stitches.at(0);
    EXPECT_EQ(pattern.edge(only.one).name, "right");
    EXPECT_EQ(pattern.edge(only.other).name, "right");
    return only.side_by_side;
  };
  EXPECT_EQ(side_by_side(panel("back", straight), ""), true);
  EXPECT_EQ(side_by_side(panel("back", straight), ", backwards = true"), false);
  EXPECT_EQ(side_by_side(mirrored("back"), ""), false);
  EXPECT_EQ(side_by_side(mirrored("back"), ", backwards = true"), true);
}

/// The places of the ends of edges on the other side of a seam.
TEST(Draft, DividesStretchesWhereTheOthersEdgesEnd) {
  const std::string three =
      R"({ line = ["b", [400, 100]], name = "right" }, { bezier = [[400, 100], [480, 150], [400, 200]], name = "right" },
  { line = [[400, 200], "c"], name = "right" })";
  for (const bool backwards : {false, true}) {
    const SewingPattern pattern =
        read(panel("front", three) + panel("back", straight) +
             stitch("panel = 'front', edge = 'right'", fmt::format("panel = 'back', edge = 'right', backwards = {}", backwards),
                    "ease = 0.2"));
    const model::PatternPanel &front = pattern.panels[0], &back = pattern.panels[1];
    ASSERT_EQ(front.edges.size(), 6);
    ASSERT_EQ(back.edges.size(), 6);
    const double curved = Curve({front.edges[2].curve}).length(), whole = 0.3 + curved;
    const double first = backwards ? 1 - 0.1 / whole : 0.1 / whole;
    expect_near(back.edges[backwards ? 3 : 1].curve.points[backwards ? 0 : 1], Vector2d(0.4, 0.4 * first));
    ASSERT_EQ(pattern.stitches.size(), 3);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(pattern.stitches[k].one.edge, 1 + k);
      EXPECT_EQ(pattern.stitches[k].other.edge, backwards ? 3 - k : 1 + k);
      const double one = Curve({pattern.edge(pattern.stitches[k].one).curve}).length();
      EXPECT_NEAR(one / Curve({pattern.edge(pattern.stitches[k].other).curve}).length(), whole / 0.4, 1e-9) << k;
    }
  }
}

/// A stretch may go on from the last edge to the first, and be sewn twice; what one seam divides, the other carries on.
TEST(Draft, DividesThroughSeveralSeams) {
  const std::string halves = R"({ line = ["b", [400, 200]], name = "right" }, { line = [[400, 200], "c"], name = "right" })";
  const std::string around = R"(
[[panels]]
name = "around"
outline = [
  { line = [[400, 300], [400, 400]], name = "right" },
  { line = [[400, 400], [0, 400]] },
  { line = [[0, 400], [0, 0]] },
  { line = [[0, 0], [400, 0]] },
  { line = [[400, 0], [400, 300]], name = "right" },
]
)";
  const SewingPattern pattern = read(panel("a", halves) + panel("b", straight) + around +
                                     stitch("panel = 'b', edge = 'right'", "panel = 'a', edge = 'right'") +
                                     stitch("panel = 'b', edge = 'right'", "panel = 'around', edge = 'right'"));
  EXPECT_EQ(pattern.panels[0].edges.size(), 6);
  EXPECT_EQ(pattern.panels[1].edges.size(), 6);
  EXPECT_EQ(pattern.panels[2].edges.size(), 6);
  ASSERT_EQ(pattern.stitches.size(), 6);
  std::vector<std::size_t> edges;
  for (std::size_t k = 3; k < 6; ++k) edges.push_back(pattern.stitches[k].other.edge);
  EXPECT_THAT(edges, ElementsAre(4, 5, 0));
  expect_near(pattern.panels[2].edges[4].curve.points[1], Vector2d(0.4, 0.2));
}

/// By the nearer ends, these would be sewn the other way round.
TEST(Draft, IsSewnAsItSays) {
  const std::string text = panel("front", straight) + panel("back", straight, "position = [0, 100, 0]") +
                           stitch("panel = 'front', edge = 'right'", "panel = 'back', edge = 'right', backwards = true");
  const model::SewnPattern sewn = model::sew(read(text), 0.1);
  EXPECT_THAT(sewn.scene.seams.at(0).one.ends, ElementsAre(0, 4));
  EXPECT_THAT(sewn.scene.seams.at(0).other.ends, ElementsAre(4, 0));
  EXPECT_THAT(sewn.remarks.at(0), HasSubstr("sewn as the pattern says"));
}

TEST(Draft, WhatIsWrongIsSaidInOneLine) {
  const auto message = [](const std::string& text) { return pattern_error("skirt.toml", text); };
  const std::string good = panel("front", straight), front = "panel = 'front', edge = 'right'";
  EXPECT_EQ(message(good), "no error");
  EXPECT_THAT(message("name = 3"), HasSubstr("skirt.toml:1: pattern = "));
  EXPECT_THAT(message("name = 3"), HasSubstr("expected 'panels' in every pattern"));
  EXPECT_THAT(message("pieces = 3\npanels = []"),
              HasSubstr("skirt.toml:1: pattern.pieces = 3: expected no such key; a pattern has name, panels, stitches"));
  EXPECT_THAT(message("panels = []"), HasSubstr("skirt.toml:1: panels = []: expected 1 to 1000 panels"));
  EXPECT_THAT(message("panels = ["), HasSubstr("skirt.toml:1: "));
  EXPECT_THAT(message("a = " + std::string(20, '[') + std::string(20, ']')),
              HasSubstr("skirt.toml:1: expected a pattern, which is not nested deeper than 16 levels"));
  EXPECT_THAT(message(good + good), HasSubstr("expected a name that no other panel has"));
  EXPECT_THAT(
      message(panel("front", R"({ line = ["b", "e"] })")),
      HasSubstr(
          "skirt.toml:7: panels.outline.line = 'e': expected [x, y] in mm or one of the points of panel front: a, b, c, d"));
  EXPECT_THAT(
      message(panel("front", R"({ line = ["b", [400, 390]], name = "right" })")),
      HasSubstr("expected edge waist of panel front to begin where edge right ends, at [400, 390], not at [400, 400]: the "
                "outline is open"));
  EXPECT_THAT(message(panel("front", R"({ line = ["b", [400, 400.005]], name = "right" })")), "no error");
  EXPECT_THAT(
      message(panel("front", R"({ line = ["b", [-100, 200]], name = "r1" }, { line = [[-100, 200], "c"], name = "r2" })")),
      HasSubstr("skirt.toml:2: panel front: edges r1 and left cross: expected an outline that does not cross itself"));
  EXPECT_THAT(message(panel("front", R"({ spline = ["b", "c"] })")), HasSubstr("skirt.toml:7: panels.outline.spline = "));
  EXPECT_THAT(message(panel("front", R"({ line = ["b", [4e6, 0]] })")),
              HasSubstr("expected coordinates in mm, of at most a million"));
  EXPECT_THAT(message(good + stitch(front, "panel = 'back', edge = 'left'")), HasSubstr("expected one of the panels front"));
  EXPECT_THAT(
      message(good + stitch(front, "panel = 'front', edge = 'top'")),
      HasSubstr("skirt.toml:14: stitches.other = { edge = 'top', panel = 'front' }: expected one of the named edges of panel "
                "front: hem, left, right, waist"));
  EXPECT_THAT(message(good + stitch(front, front)), HasSubstr("expected two stretches, not one with itself"));
  EXPECT_THAT(message(panel("front", R"({ line = ["b", "c"], name = "left" })") +
                      stitch("panel = 'front', edge = 'hem'", "panel = 'front', edge = 'left'")),
              HasSubstr("expected edges of panel front that follow each other, with others before and behind them"));
  const std::string longer =
      panel("back", R"({ line = ["b", [450, 200]], name = "right" }, { line = [[450, 200], "c"], name = "right" })");
  EXPECT_THAT(
      message(good + longer + stitch(front, "panel = 'back', edge = 'right'")),
      HasSubstr("expected lengths that differ by 2 % at most (ease = 0.02): edge right of panel front has 400.0 mm, edge "
                "right of panel back has 412.3 mm"));
  EXPECT_EQ(message(good + longer + stitch(front, "panel = 'back', edge = 'right'", "ease = 0.04")), "no error");
  const std::string close =
      panel("back", R"({ line = ["b", [400, 200]], name = "right" }, { line = [[400, 200], [400, 200.03]], name = "right" },
    { line = [[400, 200.03], [400, 200.06]], name = "right" }, { line = [[400, 200.06], "c"], name = "right" })");
  EXPECT_THAT(message(good + close + stitch(front, "panel = 'back', edge = 'right'")),
              HasSubstr("expected edges whose ends meet, or are farther apart than a thousandth of what is sewn"));
}

TEST(Pattern, IsReadByTheEndOfItsName) {
  const auto message = [](const std::string& file) -> std::string {
    try {
      model::read_pattern(file);
    } catch (const model::SceneError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("skirt.dxf"), "skirt.dxf: expected a pattern, whose name ends in .json (GarmentCode), .toml, .obj or .ply");
  for (const char* missing : {"none.json", "none.toml", "none.obj"})
    EXPECT_THAT(message(missing), HasSubstr(fmt::format("{}: ", missing)));
}

/// The patterns that are kept are sewn without gathers of more than they state, and begin outside of the mannequin.
TEST(KeptPatterns, CanBeSewn) {
  for (const auto& [name, panels, seams] : {std::tuple("circle_skirt", 4, 4), {"t_shirt", 6, 12}, {"trousers", 4, 6}}) {
    const auto sewn = model::sew(model::read_pattern(fmt::format("{}/model/patterns/{}.toml", DRAPE_SOURCE_DIR, name)), 0.03);
    EXPECT_EQ(sewn.scene.panels.size(), panels) << name;
    EXPECT_EQ(sewn.scene.seams.size(), seams) << name;
    for (const std::string& remark : sewn.remarks) EXPECT_THAT(remark, testing::Not(HasSubstr("as the pattern says"))) << name;
    const model::Cloth cloth = model::compile(sewn.scene);
    EXPECT_GE(cloth.contacts->distances(0, cloth.start.x).minCoeff(), sewn.scene.contact.distance) << name;
  }
}

/// Built-in scenes have the panels and seams of the patterns from which they were made.
TEST(KeptPatterns, AreThoseOfTheScenes) {
  for (const auto& [name, spacing] :
       {std::pair<std::string, double>("circle_skirt", 0.02), {"t_shirt", 0.02}, {"sweater", 0.0125}}) {
    const auto sewn =
        model::sew(model::read_pattern(fmt::format("{}/model/patterns/{}.toml", DRAPE_SOURCE_DIR, name)), spacing);
    const model::Scene scene = model::load_scene(name);
    ASSERT_EQ(scene.panels.size(), sewn.scene.panels.size());
    for (std::size_t k = 0; k < scene.panels.size(); ++k) {
      const model::PanelRule &own = scene.panels[k], &made = sewn.scene.panels[k];
      EXPECT_EQ(own.name, made.name);
      const solver::Vectors pattern = own.grid.parameters(), drafted = made.grid.parameters();
      ASSERT_EQ(pattern.rows(), drafted.rows()) << own.name;
      EXPECT_LE((pattern - drafted).cwiseAbs().maxCoeff(), 1e-5) << own.name;
      expect_near(own.start.position, made.start.position, 1e-5);
      expect_near(own.start.rotation, made.start.rotation, 1e-5);
    }
    ASSERT_EQ(scene.seams.size(), sewn.scene.seams.size());
    for (std::size_t k = 0; k < scene.seams.size(); ++k) {
      EXPECT_EQ(scene.seams[k].one.ends, sewn.scene.seams[k].one.ends);
      EXPECT_EQ(scene.seams[k].other.ends, sewn.scene.seams[k].other.ends);
    }
  }
}

}  // namespace
}  // namespace drape::verify::draft_test
