// The triangles of a cloth: all cells are covered, seams join, and each pair of what faces own is met once.

#include "model/collision/cloth_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "model/scene_file/scene_file.hpp"

namespace drape::verify::cloth_surface_test {
namespace {

using model::ClothSurface;
using model::Garment;

/// What the pattern's nodes are on, so that areas are those of the pattern.
double area_of(const ClothSurface& surface, const model::Vectors& x) {
  double area = 0;
  for (int k = 0; k < std::ssize(surface.faces()); ++k) {
    const auto [a, b, c] = surface.corners(k, x);
    area += (b - a).cross(c - a).norm() / 2;
  }
  return area;
}

/// That vertices and edges belong to one face each, of which they are a part.
void expect_owned_once(const ClothSurface& surface) {
  std::set<int> corners;
  std::multiset<int> vertices, edges;
  for (const ClothSurface::Face& face : surface.faces()) {
    corners.insert(face.corners.begin(), face.corners.end());
    for (const int v : face.vertices) {
      if (v < 0) continue;
      vertices.insert(v);
      EXPECT_THAT(face.corners, testing::Contains(v));
    }
    for (const int e : face.edges) {
      if (e < 0) continue;
      edges.insert(e);
      for (const int end : surface.edges()[e].ends) EXPECT_THAT(face.corners, testing::Contains(end));
    }
  }
  EXPECT_TRUE(std::ranges::equal(vertices, corners));
  std::multiset<int> all;
  for (int e = 0; e < std::ssize(surface.edges()); ++e) all.insert(e);
  EXPECT_EQ(edges, all);
}

TEST(ClothSurface, SplitsCellsAsTheirPatternHasThem) {
  const Garment garment(
      model::load_scene("hung-edge", std::vector<model::Override>{{"grid.n", "[5, 7]"}, {"grid.size", "[0.4, 0.6]"}}));
  const ClothSurface surface(garment);
  EXPECT_EQ(surface.faces().size(), 2U * 4 * 6);
  EXPECT_EQ(surface.edges().size(), 4U * 7 + 5 * 6 + 4 * 6);
  EXPECT_NEAR(area_of(surface, garment.panels().front().sheet.grid.parameters()), 0.24, 1e-12);
  EXPECT_TRUE(std::ranges::none_of(surface.faces(), &ClothSurface::Face::is_edge));
  EXPECT_THAT(surface.faces()[0].corners, testing::ElementsAre(0, 1, 5));
  EXPECT_THAT(surface.faces()[1].corners, testing::ElementsAre(6, 5, 1)) << "seen from the same side";
  expect_owned_once(surface);
}

TEST(ClothSurface, LeavesOutWhatACutDoes) {
  const Garment garment(model::load_scene("cusick"));
  const ClothSurface surface(garment);
  const model::Grid& grid = garment.panels().front().sheet.grid;
  EXPECT_LT(std::ssize(surface.faces()), 2 * (grid.nu - 1) * (grid.nv - 1));
  EXPECT_GE(area_of(surface, grid.parameters()), grid.cell_areas().sum() - 1e-12);
  std::set<int> corners;
  for (const ClothSurface::Face& face : surface.faces()) corners.insert(face.corners.begin(), face.corners.end());
  for (const int i : grid.outside()) EXPECT_FALSE(corners.contains(i) && grid.cell_areas()[i] > 0);
  expect_owned_once(surface);
}

TEST(ClothSurface, JoinsPanelsAtTheirNodes) {
  for (const std::string scene : {"dress", "sweater", "skirt"}) {
    const Garment sewn(model::load_scene(scene));
    const ClothSurface surface(sewn);
    expect_owned_once(surface);
    std::size_t cells = 0;
    for (const Garment::Panel& panel : sewn.panels())
      cells += static_cast<std::size_t>((panel.sheet.grid.nu - 1) * (panel.sheet.grid.nv - 1));
    EXPECT_EQ(surface.faces().size(), 2 * cells) << scene;
  }
}

TEST(ClothSurface, HasOnlyEdgesOfChains) {
  const Garment garment(model::load_scene("chain"));
  const ClothSurface surface(garment);
  EXPECT_EQ(std::ssize(surface.faces()), garment.nodes() - 1);
  EXPECT_EQ(std::ssize(surface.edges()), garment.nodes() - 1);
  EXPECT_TRUE(std::ranges::all_of(surface.faces(), &ClothSurface::Face::is_edge));
  EXPECT_TRUE(std::ranges::none_of(surface.edges(), &ClothSurface::Edge::has_face));
  expect_owned_once(surface);
}

TEST(ClothSurface, KnowsFacesWithACommonNode) {
  const std::vector<std::array<int, 3>> faces{{0, 1, 2}, {2, 3, 4}, {3, 4, 5}};
  const ClothSurface surface(faces, model::Vectors::Random(6, 3));
  EXPECT_TRUE(surface.joined(0, 1));
  EXPECT_FALSE(surface.joined(0, 2));
}

}  // namespace
}  // namespace drape::verify::cloth_surface_test
