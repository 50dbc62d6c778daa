#pragma once

#include <Eigen/Core>
#include <array>

#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// The unit normal of the plane that separates two faces of a sheet [Etzmuß 2002, 5.3]: it contains their common edge, a vector
/// as the first face goes round, and halves the angle between them. Positive distances are on the side of the first face.
/// `first` and `second`: unit normals of the faces; twice the same on the border.
///
/// The printed normal, n_f × n_fi, is parallel to the edge, so that its plane would cut the edge.
Eigen::Vector3d separating_normal(const Eigen::Vector3d& edge, const Eigen::Vector3d& first, const Eigen::Vector3d& second);

/// Projects points onto the plane of a face through C_f, where its separating planes meet [Etzmuß 2002, 5.3].
///
/// The distances from the planes, each divided by that of the corner opposite to its edge, are homogeneous barycentric
/// coordinates of the image. Their sum is 1 on the face and 0 in C_f. If it is 1 everywhere the planes do not meet and the
/// projection is parallel, which is then no special case and needs no threshold.
class FaceProjection {
 public:
  /// `separating`: unit normals of the planes through the edges from corner k to the next, which point to the face.
  FaceProjection(const Corners& corners, const std::array<Eigen::Vector3d, 3>& separating);

  /// Homogeneous barycentric coordinates of a point's image [1].
  Eigen::Vector3d weights(const Eigen::Vector3d& point) const;

  /// Barycentric coordinates of the image [1].
  Eigen::Vector3d barycentric(const Eigen::Vector3d& point) const;

  /// The point of the face with these barycentric coordinates [m].
  Eigen::Vector3d on_face(const Eigen::Vector3d& barycentric) const;

  /// Height of a point above the plane of the face, on the side of its normal [m].
  double height(const Eigen::Vector3d& point) const { return normal_.dot(point - corners_[0]); }

  /// The direction in which points move away from the face while their image stays; its product with the normal is 1.
  Eigen::Vector3d away(const Eigen::Vector3d& point) const;

 private:
  Corners corners_;
  Eigen::Vector3d normal_;
  std::array<Eigen::Vector3d, 3> gradients_;  ///< of the weights [1/m]
  double growth_;               ///< of the sum of the weights with height; of each in the share of its image [1/m]
  Eigen::Matrix3d directions_;  ///< of rising weights of corner 0, of corner 1, and height, the others constant
};

/// The part of a segment XY, from 0 to 1, whose image is this part of the segment's image, by the invariance of the cross ratio
/// [Etzmuß 2002, 5.3 step 4]. `ratio`: the sum of the weights in Y over that in X, which is τ/(1 − τ) for the image τ of the
/// middle of XY, the auxiliary point A.
double lift(double image, double ratio);

}  // namespace drape::model
