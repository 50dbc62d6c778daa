// Garment meshes as patterns: islands of their texture coordinates, their edges, what is sewn, and where panels begin.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>
#include <string>
#include <vector>

#include "model/garment.hpp"
#include "model/pattern/sewn_pattern.hpp"
#include "verify/support/pattern_files.hpp"

namespace drape::verify::garment_mesh_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using model::Curve;
using model::SewingPattern;
using testing::ElementsAre;
using testing::HasSubstr;

SewingPattern read(const std::string& text) { return pattern_of("tube.obj", text); }

/// A mesh of rectangles, each with its own vertices on the pattern.
class Drawing {
 public:
  /// A rectangle of cells on the pattern, in space where `place` puts them: points that are the same there are one vertex.
  template <class Place>
  Drawing& add(int nu, int nv, const Vector2d& origin, const Vector2d& cell, Place place) {
    const int first = static_cast<int>(coordinates_.size());
    std::vector<int> vertices;
    for (int b = 0; b <= nv; ++b)
      for (int a = 0; a <= nu; ++a) {
        coordinates_.emplace_back(origin + Vector2d(a * cell.x(), b * cell.y()));
        vertices.push_back(vertex(place(a / double(nu), b / double(nv))));
      }
    for (int b = 0; b < nv; ++b)
      for (int a = 0; a < nu; ++a) {
        const int corner[] = {a + (nu + 1) * b, a + 1 + (nu + 1) * b, a + 1 + (nu + 1) * (b + 1), a + (nu + 1) * (b + 1)};
        faces_ += "f";
        for (const int k : corner) faces_ += fmt::format(" {}/{}/1", vertices[static_cast<std::size_t>(k)] + 1, first + k + 1);
        faces_ += "\n";
      }
    return *this;
  }

  std::string text() const {
    std::string all = "# a comment\nvn 0 0 1\n";
    for (const Vector3d& v : vertices_) all += fmt::format("v {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
    for (const Vector2d& p : coordinates_) all += fmt::format("vt {:.17g} {:.17g}\n", p.x(), p.y());
    return all + "g garment\n" + faces_;
  }

 private:
  int vertex(const Vector3d& v) {
    for (std::size_t k = 0; k < vertices_.size(); ++k)
      if ((vertices_[k] - v).norm() < 1e-9) return static_cast<int>(k);
    vertices_.push_back(v);
    return static_cast<int>(vertices_.size()) - 1;
  }

  std::vector<Vector3d> vertices_;
  std::vector<Vector2d> coordinates_;
  std::string faces_;
};

/// Half of a flat tube, whose two halves are sewn along both sides: u from left to right at y = ±0.2.
auto half(double y) {
  return [y](double u, double v) -> Vector3d { return {u - 0.5, u == 0 || u == 1 ? 0 : y, 0.6 * v}; };
}

TEST(GarmentMesh, HasPanelsOfIslandsAndStitchesOfEdgesThatAreOneInSpace) {
  const SewingPattern pattern =
      read(Drawing().add(10, 6, {0, 0}, {0.1, 0.1}, half(-0.2)).add(10, 6, {3, 1}, {0.1, 0.1}, half(0.2)).text());
  ASSERT_EQ(pattern.panels.size(), 2);
  for (const model::PatternPanel& panel : pattern.panels) {
    ASSERT_EQ(panel.edges.size(), 4) << panel.name;
    double around = 0;
    for (const model::PatternEdge& edge : panel.edges) around += Curve({edge.curve}).length();
    EXPECT_NEAR(around, 3.2, 1e-12);
  }
  ASSERT_EQ(pattern.stitches.size(), 2);
  for (const model::Stitch& stitch : pattern.stitches) {
    EXPECT_NEAR(Curve({pattern.edge(stitch.one).curve}).length(), 0.6, 1e-12);
    EXPECT_NEAR(pattern.edge(stitch.one).curve.points[0].y() + 1, pattern.edge(stitch.other).curve.points[0].y(), 1e-12);
    EXPECT_EQ(stitch.side_by_side, true) << "both halves go round the same way on the pattern";
  }
  const model::SewnPattern sewn = model::sew(pattern, 0.1);
  EXPECT_EQ(model::nodes(sewn.scene), 2 * 11 * 7 - 2 * 7);
}

/// The fit finds a rigid motion exactly, also of an island that is drawn from its other face.
TEST(GarmentMesh, PanelsBeginWhereTheyAreInSpace) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const double side : {1.0, -1.0}) {
    const auto place = [&](double u, double v) -> Vector3d {
      return turn * Vector3d(side * u, 0.3, 0.5 * v) + Vector3d(1, 2, 3);
    };
    const SewingPattern pattern = read(Drawing().add(4, 2, {2, 1}, {0.25, 0.25}, place).text());
    ASSERT_EQ(pattern.panels.size(), 1);
    const model::PatternPanel& panel = pattern.panels[0];
    EXPECT_NEAR(panel.rotation.determinant(), 1, 1e-12);
    for (const auto& [u, v] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.5, 1.0}}) {
      const Vector3d there = panel.position + panel.rotation * Vector3d(2 + u, 0, 1 + 0.5 * v);
      EXPECT_LE((there - place(u, v)).norm(), 1e-12);
    }
  }
}

/// One island that is drawn mirrored shows its other face.
TEST(GarmentMesh, MirroredIslandsAreSewnFaceToFace) {
  const SewingPattern pattern =
      read(Drawing().add(4, 4, {0, 0}, {0.25, 0.15}, half(-0.2)).add(4, 4, {3, 0}, {-0.25, 0.15}, half(0.2)).text());
  ASSERT_EQ(pattern.stitches.size(), 2);
  for (const model::Stitch& stitch : pattern.stitches) EXPECT_EQ(stitch.side_by_side, false);
}

/// A seam that ends at a third of a side, and one side sewn to two panels.
TEST(GarmentMesh, EdgesEndWhereSeamsDo) {
  const auto at = [](double x, double z, double width, double height) {
    return [=](double u, double v) -> Vector3d { return {x + width * u, 0, z + height * v}; };
  };
  const SewingPattern pattern = read(Drawing()
                                         .add(3, 6, {0, 0}, {0.1, 0.1}, at(0, 0, 0.3, 0.6))
                                         .add(3, 2, {1, 0}, {0.1, 0.1}, at(0.3, 0, 0.3, 0.2))
                                         .add(3, 2, {1, 1}, {0.1, 0.1}, at(0.3, 0.2, 0.3, 0.2))
                                         .text());
  ASSERT_EQ(pattern.panels.size(), 3);
  EXPECT_EQ(pattern.panels[0].edges.size(), 6);
  EXPECT_EQ(pattern.panels[1].edges.size(), 4);
  EXPECT_EQ(pattern.stitches.size(), 3) << "the two small ones are joined as well";
  std::vector<double> ends;
  for (const model::PatternEdge& edge : pattern.panels[0].edges)
    if (edge.curve.points.front().x() > 0.29 && edge.curve.points.back().x() > 0.29)
      ends.push_back(edge.curve.points.back().y());
  std::ranges::sort(ends);
  EXPECT_THAT(ends,
              ElementsAre(testing::DoubleNear(0.2, 1e-12), testing::DoubleNear(0.4, 1e-12), testing::DoubleNear(0.6, 1e-12)));
}

/// Where the border of one panel turns, the straight one to which it is sewn ends an edge as well.
TEST(GarmentMesh, EdgesEndWhereTheOtherBorderTurns) {
  const SewingPattern pattern = read(R"(v 0 0 0
v 0 0 1
v 0 0 2
v -1 0 0
v -1 0 2
v 1 0 0
v 1 0 2
vt 1 0
vt 1.5 1
vt 1 2
vt 0 0
vt 0 2
vt 3 0
vt 3 1
vt 3 2
vt 4 0
vt 4 2
f 4/4 1/1 2/2
f 4/4 2/2 5/5
f 5/5 2/2 3/3
f 1/6 6/9 2/7
f 2/7 6/9 7/10
f 2/7 7/10 3/8
)");
  ASSERT_EQ(pattern.panels.size(), 2);
  for (const model::PatternPanel& panel : pattern.panels) EXPECT_EQ(panel.edges.size(), 5) << panel.name;
  EXPECT_EQ(pattern.stitches.size(), 2);
}

/// A wedge: 20 degrees are no corner, 45 degrees are.
TEST(GarmentMesh, EdgesEndWhereTheBorderTurns) {
  const std::string text = R"(v 0 0 0
v 1 0 0
v 2 0 -0.36
v 2 0 1
v 0 0 1
vt 0 0
vt 1 0
vt 2 -0.36
vt 2 1
vt 0 1
f 1/1 2/2 5/5
f 2/2 4/4 5/5
f 2/2 3/3 4/4
)";
  EXPECT_EQ(read(text).panels.at(0).edges.size(), 4);
  std::string steeper = text;
  for (const auto& [from, to] : {std::pair("v 2 0 -0.36", "v 2 0 -1"), {"vt 2 -0.36", "vt 2 -1"}})
    steeper.replace(steeper.find(from), std::string(from).size(), to);
  EXPECT_EQ(read(steeper).panels.at(0).edges.size(), 5);
}

TEST(GarmentMesh, WhatIsWrongIsSaidInOneLine) {
  const auto message = [](const std::string& text) { return pattern_error("tube.obj", text); };
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0\n";
  EXPECT_EQ(message(corners + "f 1/1 2/2 3/3 4/4\n"), "no error");
  EXPECT_EQ(message(corners + "f -4/-5 -3/-4 -2/-3 -1/-2\n"), "no error");
  EXPECT_THAT(message(corners), HasSubstr("tube.obj: expected an OBJ with faces"));
  EXPECT_THAT(message("v 0 0\n"), HasSubstr("tube.obj:1: expected 3 numbers, of at most a million"));
  EXPECT_THAT(message(corners + "f 1 2 3\n"),
              HasSubstr("tube.obj:10: '1': expected texture coordinates, which are those of the pattern (v/vt)"));
  EXPECT_THAT(message(corners + "f 1//1 2//1 3//1\n"), HasSubstr("tube.obj:10: '1//1': expected texture coordinates"));
  EXPECT_THAT(message(corners + "f 1/1 2/2\n"), HasSubstr("tube.obj:10: expected a face of at least three corners"));
  EXPECT_THAT(message(corners + "f 1/1 2/2 5/3\n"), HasSubstr("tube.obj:10: '5': expected one of the 4 vertices before it"));
  EXPECT_THAT(message(corners + "f 1/1 2/2 3/9\n"),
              HasSubstr("tube.obj:10: '9': expected one of the 5 texture coordinates before it"));
  EXPECT_THAT(message(corners + "f 1/1 2/2 3/3\nf 1/1 2/5 3/2\n"),
              HasSubstr("tube.obj:11: expected a triangle that has an area on the pattern"));
  EXPECT_THAT(
      message(corners + "f 1/1 2/2 3/3\nf 1/1 4/4 3/3\n"),
      HasSubstr("tube.obj:11: the triangle is turned over on the pattern: expected all of its island to show the same face"));
  EXPECT_THAT(message(corners + "f 1/1 2/2 3/3\nf 1/1 2/2 4/4\nf 1/1 2/2 4/3\n"),
              HasSubstr("expected edges of at most two triangles on the pattern"));
  EXPECT_THAT(message(corners + "f 1/1 2/2 3/3\n"), HasSubstr("panel island 0: expected four corners beside darts"));
  std::string large = corners;
  for (const char* from : {"vt 1 0", "vt 1 1", "vt 0 1"})
    large.replace(large.find(from), 4, std::string(from).substr(0, 4) + "00");
  EXPECT_THAT(message(large + "f 1/1 2/2 3/3 4/4\n"),
              HasSubstr("expected vertices and texture coordinates in metres, the pattern has "));
  // A frame around a hole.
  std::string ring;
  for (const double r : {1.0, 2.0})
    for (int k = 0; k < 4; ++k) {
      const double x = r * std::cos(k * std::numbers::pi / 2), z = r * std::sin(k * std::numbers::pi / 2);
      ring += fmt::format("v {} 0 {}\nvt {} {}\n", x, z, x, z);
    }
  for (int k = 1; k <= 4; ++k) {
    const int next = k % 4 + 1;
    ring += fmt::format("f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", k, k + 4, next + 4, next);
  }
  EXPECT_THAT(message(ring),
              HasSubstr("tube.obj:17: the island of this face: expected a disc, with one border and without holes"));
  // Three pieces of cloth along one edge.
  std::string three = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 1 1\nv 0 -1 1\n";
  for (int k = 0; k < 3; ++k) three += fmt::format("vt {} 0\nvt {} 0\nvt {} 1\n", 3 * k, 3 * k + 1, 3 * k);
  for (int k = 0; k < 3; ++k) three += fmt::format("f 1/{} 2/{} {}/{}\n", 3 * k + 1, 3 * k + 2, 3 + k, 3 * k + 3);
  EXPECT_THAT(message(three),
              HasSubstr("tube.obj: vertices 1 and 2: expected at most two pieces of cloth along an edge, not 3"));
}

}  // namespace
}  // namespace drape::verify::garment_mesh_test
