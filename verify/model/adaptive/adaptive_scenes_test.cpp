// The scenes of table 5.1 and of figure 5.13: coarse sheets that only virtual particles keep out of obstacles.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "model/adaptive/sheet_refinement.hpp"
#include "model/collision/exact_intersection.hpp"
#include "verify/support/contact_scenes.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::adaptive_scenes_test {
namespace {

using namespace contact_scenes;
using Eigen::Vector3d;
using model::Corners;

/// Triangles with the boxes around them.
struct Triangles {
  std::vector<Corners> corners;
  std::vector<Eigen::AlignedBox3d> boxes;

  void add(const Corners& c) {
    corners.push_back(c);
    boxes.emplace_back(c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]));
  }
};

/// Number of pairs with a point in common.
int intersections(const Triangles& one, const Triangles& other) {
  int count = 0;
  for (std::size_t i = 0; i < one.corners.size(); ++i)
    for (std::size_t j = 0; j < other.corners.size(); ++j)
      if (one.boxes[i].intersects(other.boxes[j])) count += model::intersect(one.corners[i], other.corners[j]) ? 1 : 0;
  return count;
}

/// The obstacle of a scene, smaller by a billionth so that touching does not count.
Triangles obstacle_of(const model::Scene& scene) {
  const model::BodySurface body(scene.obstacles);
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& vertex : body.mesh().vertices) centre += vertex / std::ssize(body.mesh().vertices);
  Triangles all;
  for (const auto& triangle : body.mesh().triangles) {
    Corners c = corners(body.mesh(), triangle);
    for (Vector3d& corner : c) corner = centre + (1 - 1e-9) * (corner - centre);
    all.add(c);
  }
  return all;
}

Triangles sheet_of(const model::Polygons& polygons) {
  Triangles all;
  for (const std::vector<int>& face : polygons.faces)
    all.add({polygons.vertices[face[0]], polygons.vertices[face[1]], polygons.vertices[face[2]]});
  return all;
}

const std::vector<std::string> scenes{"box_four", "round_table_100", "square_table_400", "ball_100"};

class AdaptiveScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, AdaptiveScene, testing::ValuesIn(scenes), [](const auto& test) { return test.param; });

/// Frames of a run.
struct Frames {
  int all = 0;
  int whole = 0;                ///< those in which the coarse sheet intersects the obstacle
  std::vector<double> refined;  ///< times of those in which the refined sheet does
};

Frames frames_of(const Trial& trial, const std::string& method, double step) {
  model::SheetRefinement refinement(*trial.cloth.garment, trial.scene.obstacles);
  model::SheetRefinement coarse(*trial.cloth.garment, {});
  const Triangles obstacle = obstacle_of(trial.scene);
  Frames frames;
  for (const Moment& moment : run(trial, method, step)) {
    frames.whole += intersections(sheet_of(coarse.polygons(moment.t, moment.y.x)), obstacle) > 0 ? 1 : 0;
    if (intersections(sheet_of(refinement.polygons(moment.t, moment.y.x)), obstacle) > 0) frames.refined.push_back(moment.t);
    ++frames.all;
  }
  return frames;
}

TEST_P(AdaptiveScene, HasNoFaceThroughItsObstacle) {
  const Trial trial = builtin(GetParam());
  const Frames frames = frames_of(trial, "implicit-euler", 0.01);
  EXPECT_THAT(frames.refined, testing::IsEmpty()) << "of " << frames.all << " frames";
  EXPECT_GT(frames.whole, frames.all / 4) << "there is something to refine";
  EXPECT_GT(trial.cloth.ode.work->counter("divided_springs", ""), frames.all) << "and forces depend on it";
}

TEST_P(AdaptiveScene, HasNoneByOtherMethodsAndSteps) {
  DRAPE_SLOW();
  for (const std::string& method : methods())
    for (const double step : {0.005, 0.02}) {
      const Trial trial = builtin(GetParam());
      EXPECT_THAT(frames_of(trial, method, step).refined, testing::IsEmpty()) << method << ", " << step;
    }
}

/// [Etzmuß 2002, 5.2, fig. 5.13]
TEST(AdaptiveScenes, FourParticlesFallThroughABoxWithoutVirtualOnes) {
  const std::vector<model::Override> plain{model::parse_override("contact.adaptive=false")};
  const Trial with = builtin("box_four"), without = builtin("box_four", plain);
  const double fallen = -run(without, "implicit-euler", 0.01).back().y.x.col(2).maxCoeff();
  EXPECT_NEAR(fallen, 9.81 / 2, 0.06) << "free fall";
  const auto moments = run(with, "implicit-euler", 0.01);
  EXPECT_GT(moments.back().y.x.col(2).minCoeff(), -0.16) << "half of the sheet hangs over either side";
  EXPECT_LT(moments.back().y.x.col(2).maxCoeff(), -0.05);
}

TEST(AdaptiveScenes, TheBallHas1227Edges) {
  const model::Scene scene = model::load_scene("ball_100");
  const model::BodySurface body(scene.obstacles);
  EXPECT_EQ(body.mesh().vertices.size(), 411U);
  EXPECT_EQ(model::EdgeMesh("the ball", body.mesh().triangles).edges().size(), 1227U);
  for (const Vector3d& vertex : body.mesh().vertices) EXPECT_NEAR((vertex - Vector3d(0.4, 0.4, -0.21)).norm(), 0.2, 1e-15);
}

TEST(AdaptiveScenes, SpheresOfAnyNumberOfVerticesAreClosed) {
  for (const int n : {20, 21, 50, 411, 1000}) {
    const auto scene = model::parse_scene(
        fmt::format(
            "name = 'a'\ngrid.n = 3\nobstacles = [{{ shape = 'sphere', radius = 2, vertices = {}, position = [0, 0, -9] }}]\n",
            n),
        "a");
    const model::BodySurface body(scene.obstacles);
    EXPECT_EQ(std::ssize(body.mesh().vertices), n);
    EXPECT_EQ(std::ssize(body.mesh().triangles), 2 * n - 4);
  }
}

}  // namespace
}  // namespace drape::verify::adaptive_scenes_test
