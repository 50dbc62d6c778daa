// Pairs of faces of cloth and obstacles, against all pairs.

#include "model/collision/body_faces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <string>
#include <vector>

#include "model/collision/face_distance.hpp"
#include "verify/support/obstacles.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::body_faces_test {
namespace {

using Eigen::Vector3d;
using model::ClothSurface;
using model::Corners;
using model::PosedObstacle;
using model::Vectors;

/// A square of 2 m on each side of n × n particles, at this height.
struct FlatSquare {
  std::vector<std::array<int, 3>> faces;
  Vectors x;

  FlatSquare(int n, double height) : x(n * n, 3) {
    for (int b = 0; b < n; ++b)
      for (int a = 0; a < n; ++a) {
        const int i = a + n * b;
        x.row(i) << 2.0 * a / (n - 1) - 1, 2.0 * b / (n - 1) - 1, height;
        if (a + 1 == n || b + 1 == n) continue;
        faces.push_back({i, i + 1, i + n});
        faces.push_back({i + n + 1, i + n, i + 1});
      }
  }
};

TEST(BodyFaces, AreAllPairsThatAreNear) {
  DRAPE_SLOW();
  int pairs = 0;
  std::mt19937 random(3);
  std::normal_distribution<double> moved(0, 0.1);
  for (const char* shape : {"shape = 'box', size = [0.8, 0.6, 0.4]", "shape = 'sphere', radius = 0.5",
                            "shape = 'cylinder', radius = 0.3, height = 1", "shape = 'plane'"}) {
    const std::string motion =
        ", motion = [{ time = 0, position = [0, 0, -1] }, { time = 1, position = [0, 0, 0.5], "
        "rotation = [0, 20, 40] }]";
    const std::vector<PosedObstacle> bodies{{verify::obstacle(shape + motion), 3.0}};
    for (int k = 0; k < 10; ++k) {
      FlatSquare sheet(9, 0);
      for (int i = 0; i < sheet.x.size(); ++i) sheet.x.data()[i] += moved(random);
      const ClothSurface surface(sheet.faces, sheet.x);
      const double t = 0.1 * k, distance = 0.01 * k;
      int expected = 0;
      const model::Polygons polygons = bodies[0].at(t);
      for (const std::vector<int>& face : polygons.faces)
        for (std::size_t c = 1; c + 1 < face.size(); ++c)
          for (int i = 0; i < std::ssize(sheet.faces); ++i) {
            const Corners body{polygons.vertices[face[0]], polygons.vertices[face[c]], polygons.vertices[face[c + 1]]};
            expected += model::nearer(surface.corners(i, sheet.x), body, distance) ? 1 : 0;
          }
      EXPECT_EQ(model::face_pairs(surface, bodies, t, sheet.x, distance), expected) << shape << " at " << t;
      pairs += expected;
    }
  }
  EXPECT_GT(pairs, 2000);
}

/// The top of the box is two triangles, which lie below 8 of the sheet, and the sides are below those at the border alone.
TEST(BodyFaces, AreThoseAboveTheBox) {
  const FlatSquare sheet(3, 0.52);
  const ClothSurface surface(sheet.faces, sheet.x);
  const std::vector<PosedObstacle> bodies{{verify::obstacle("shape = 'box', size = [0.5, 0.5, 1]"), 3.0}};
  EXPECT_EQ(model::face_pairs(surface, bodies, 0, sheet.x, 0.01), 0);
  EXPECT_GT(model::face_pairs(surface, bodies, 0, sheet.x, 0.03), 0);
  EXPECT_EQ(model::face_pairs(surface, {}, 0, sheet.x, 1), 0);
}

/// A sheet just above a box and one through its sides, between whose particles the box stands.
TEST(BodyFaces, IntersectWhereTheBoxStandsBetweenParticles) {
  const std::vector<PosedObstacle> bodies{{verify::obstacle("shape = 'box', size = [0.5, 0.5, 1]"), 3.0}};
  for (const double height : {0.499, 0.501}) {
    const FlatSquare sheet(2, height);
    const auto found = model::body_intersections(ClothSurface(sheet.faces, sheet.x), bodies, 0, sheet.x);
    EXPECT_EQ(found.empty(), height > 0.5) << height;
  }
}

}  // namespace
}  // namespace drape::verify::body_faces_test
