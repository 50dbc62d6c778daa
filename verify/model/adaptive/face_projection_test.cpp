// Projection of points onto faces of a sheet, and back.

#include "model/adaptive/face_projection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace drape::verify::face_projection_test {
namespace {

using Eigen::Vector3d;
using model::Corners;
using model::FaceProjection;

/// A triangle with three neighbours; the projection onto it.
struct FaceWithNeighbours {
  Corners corners;
  Vector3d normal;
  std::array<Vector3d, 3> neighbours;  ///< unit normals
  std::array<Vector3d, 3> separating;

  /// `slope`: how far neighbours are turned round their edges, at most [rad].
  FaceWithNeighbours(std::mt19937& random, double slope) {
    std::uniform_real_distribution<double> any(-1, 1);
    corners = {Vector3d(any(random), any(random), any(random)), Vector3d(3 + any(random), any(random), any(random)),
               Vector3d(1 + any(random), 3 + any(random), any(random))};
    normal = model::face_normal(corners);
    for (int k = 0; k < 3; ++k) {
      const Vector3d edge = corners[(k + 1) % 3] - corners[k];
      neighbours[k] = Eigen::AngleAxisd(slope * any(random), edge.normalized()) * normal;
      separating[k] = model::separating_normal(edge, normal, neighbours[k]);
    }
  }

  FaceProjection projection() const { return {corners, separating}; }
};

template <class Check>
void for_random_faces(double slope, const Check& check) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const FaceWithNeighbours face(random, slope);
    // Heights from which all is nearer than the centre: the planes lean by half of the slope at most.
    const auto point = [&] {
      return Vector3d((face.corners[0] + face.corners[1] + face.corners[2]) / 3 + Vector3d(any(random), any(random), 0) +
                      0.5 * (1 + any(random)) * face.normal);
    };
    check(face, point(), point(), 0.5 * (1 + any(random)));
  }
}

TEST(FaceProjection, SeparatesFacesByThePlaneThatHalvesTheirAngle) {
  for_random_faces(1, [](const FaceWithNeighbours& face, const Vector3d& point, const Vector3d&, double) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d &from = face.corners[k], &n = face.separating[k];
      EXPECT_NEAR(n.dot(face.corners[(k + 1) % 3] - from), 0, 1e-14) << "it contains the edge";
      EXPECT_GT(n.dot(face.corners[(k + 2) % 3] - from), 0) << "positive where the face is";
      const Vector3d in_plane = point - n.dot(point - from) * n;
      EXPECT_NEAR(face.normal.dot(in_plane - from), face.neighbours[k].dot(in_plane - from), 1e-14) << "as high above both";
    }
  });
}

TEST(FaceProjection, GoesThroughThePointWhereThePlanesMeet) {
  for_random_faces(0.6, [](const FaceWithNeighbours& face, const Vector3d& point, const Vector3d&, double) {
    Eigen::Matrix3d normals;
    Vector3d offsets;
    for (int k = 0; k < 3; ++k) {
      normals.row(k) = face.separating[k];
      offsets[k] = face.separating[k].dot(face.corners[k]);
    }
    const Vector3d centre = normals.fullPivLu().solve(offsets);
    if (centre.norm() > 1e3) return;
    const FaceProjection projection = face.projection();
    const Vector3d image = projection.on_face(projection.barycentric(point));
    EXPECT_NEAR((image - centre).normalized().cross(point - centre).norm(), 0, 1e-11);
    EXPECT_NEAR(projection.height(image), 0, 1e-13);
    EXPECT_NEAR(projection.weights(centre).sum(), 0, 1e-11);
    EXPECT_NEAR(projection.weights(image).sum(), 1, 1e-13);
  });
}

TEST(FaceProjection, IsParallelInAFlatSheet) {
  for_random_faces(0, [](const FaceWithNeighbours& face, const Vector3d& point, const Vector3d&, double) {
    const FaceProjection projection = face.projection();
    const Vector3d image = projection.on_face(projection.barycentric(point));
    EXPECT_NEAR((image + projection.height(point) * face.normal - point).norm(), 0, 1e-13);
    EXPECT_NEAR(projection.weights(point).sum(), 1, 1e-13);
    EXPECT_NEAR((projection.away(point) - face.normal).norm(), 0, 1e-13);
  });
}

TEST(FaceProjection, KeepsTheImagesOfPointsThatMoveAway) {
  for_random_faces(0.6, [](const FaceWithNeighbours& face, const Vector3d& point, const Vector3d&, double) {
    const FaceProjection projection = face.projection();
    const Vector3d away = projection.away(point);
    EXPECT_NEAR(away.dot(face.normal), 1, 1e-13);
    EXPECT_NEAR((projection.barycentric(point + 0.1 * away) - projection.barycentric(point)).norm(), 0, 1e-12);
  });
}

TEST(FaceProjection, ReturnsToALiftedPoint) {
  double ratios = 0;
  for (const double slope : {0.0, 1e-9, 0.1, 0.6})
    for_random_faces(slope, [&](const FaceWithNeighbours& face, const Vector3d& x, const Vector3d& y, double part) {
      const FaceProjection projection = face.projection();
      const auto image = [&](const Vector3d& p) { return projection.on_face(projection.barycentric(p)); };
      const double ratio = projection.weights(y).sum() / projection.weights(x).sum();
      const Vector3d on_image = image(x) + part * (image(y) - image(x));
      const Vector3d lifted = x + model::lift(part, ratio) * (y - x);
      EXPECT_NEAR((image(lifted) - on_image).norm(), 0, 1e-12);
      ratios = std::max(ratios, std::abs(ratio - 1));
    });
  EXPECT_GT(ratios, 0.2) << "some are far from affine";
}

/// With the auxiliary point A in the middle, as printed.
TEST(FaceProjection, LiftsByTheCrossRatio) {
  for_random_faces(0.6, [](const FaceWithNeighbours& face, const Vector3d& x, const Vector3d& y, double part) {
    const FaceProjection projection = face.projection();
    const auto image = [&](const Vector3d& p) { return projection.on_face(projection.barycentric(p)); };
    const Vector3d along = image(y) - image(x);
    const double middle = along.dot(image((x + y) / 2) - image(x)) / along.squaredNorm();
    const auto ratio = [](double t) { return t / (1 - t); };
    const double lifted = model::lift(part, projection.weights(y).sum() / projection.weights(x).sum());
    EXPECT_NEAR(ratio(lifted) / ratio(0.5), ratio(part) / ratio(middle), 1e-9 * (1 + ratio(part)));
  });
}

}  // namespace
}  // namespace drape::verify::face_projection_test
