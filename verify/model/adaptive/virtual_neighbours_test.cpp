// Springs that a box divides.

#include "model/adaptive/virtual_neighbours.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "model/adaptive/virtual_particles.hpp"
#include "verify/support/sheet_over_body.hpp"

namespace drape::verify::virtual_neighbours_test {
namespace {

using Eigen::Vector3d;

/// Two particles on either side of a bar along y that is as broad as it is given, and a spring in either direction.
struct OverABar {
  TriangleSheet sheet{2};
  model::TriangleMesh bar;
  std::vector<model::Edge> springs{{0, 1, true, 1.7, 1}, {3, 2, true, 1.3, 1}, {0, 2, false, 1, 1}};

  explicit OverABar(double breadth, double height) : bar(box_mesh({breadth, 6, 2})) {
    for (Vector3d& vertex : bar.vertices) vertex.z() += height - 1;
  }

  std::vector<model::DividedSpring> divided() const {
    solver::Counters work;
    model::VirtualParticles search(sheet.faces, sheet.x, bar, work);
    return model::VirtualNeighbours(search.sheet(), springs).find(sheet.x, search.find(sheet.x, bar.vertices));
  }
};

TEST(VirtualNeighbours, AreTheNextOnEitherSide) {
  const OverABar scene(0.4, 0.5);
  const auto divided = scene.divided();
  ASSERT_EQ(divided.size(), 2U) << "the diagonal has no spring, the spring along the bar is not divided";
  const double side = std::hypot(0.8, 0.5);
  for (const model::DividedSpring& spring : divided) {
    const model::Edge& edge = scene.springs[spring.spring];
    const double i_side = scene.sheet.x(edge.i, 0), y = scene.sheet.x(edge.i, 1);
    EXPECT_NEAR((spring.of_i.particle.position - Vector3d(0.2 * i_side, y, 0.5)).norm(), 0, 1e-14);
    EXPECT_NEAR((spring.of_j.particle.position - Vector3d(-0.2 * i_side, y, 0.5)).norm(), 0, 1e-14);
    EXPECT_NEAR(spring.of_i.length, edge.length * side / (2 * side + 0.4), 1e-14);
    EXPECT_NEAR(spring.of_j.length, spring.of_i.length, 1e-14);
  }
}

TEST(VirtualNeighbours, AreNotThereWithoutAnObstacle) { EXPECT_TRUE(OverABar(0.4, -0.1).divided().empty()); }

/// The top of the bar is a hair above the sheet: forces are those of the whole springs except for that.
TEST(VirtualNeighbours, ChangeNoForceOnALine) {
  const OverABar scene(0.4, 2e-12);
  const auto divided = scene.divided();
  ASSERT_EQ(divided.size(), 2U);
  for (const model::DividedSpring& spring : divided) {
    const model::Edge& edge = scene.springs[spring.spring];
    const auto strain = [&](const Vector3d& from, const model::VirtualNeighbour& to) {
      return (to.particle.position - from).norm() / to.length - 1;
    };
    EXPECT_NEAR(strain(scene.sheet.x.row(edge.i), spring.of_i), 2 / edge.length - 1, 1e-14);
    EXPECT_NEAR(strain(scene.sheet.x.row(edge.j), spring.of_j), 2 / edge.length - 1, 1e-14);
  }
}

}  // namespace
}  // namespace drape::verify::virtual_neighbours_test
