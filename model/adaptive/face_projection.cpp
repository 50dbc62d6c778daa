#include "model/adaptive/face_projection.hpp"

#include <Eigen/Dense>

namespace drape::model {

Eigen::Vector3d separating_normal(const Eigen::Vector3d& edge, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  constexpr double folded = 1e-9;  // faces back to back have no such plane
  const Eigen::Vector3d middle = first + second;
  return (middle.norm() > folded ? middle : first).cross(edge).normalized();
}

FaceProjection::FaceProjection(const Corners& corners, const std::array<Eigen::Vector3d, 3>& separating)
    : corners_(corners), normal_(face_normal(corners)) {
  for (int k = 0; k < 3; ++k) {
    const int opposite = (k + 2) % 3;
    gradients_[opposite] = separating[k] / separating[k].dot(corners[opposite] - corners[k]);
  }
  growth_ = normal_.dot(gradients_[0] + gradients_[1] + gradients_[2]);
  Eigen::Matrix3d rows;
  rows << gradients_[0].transpose(), gradients_[1].transpose(), normal_.transpose();
  directions_ = rows.inverse();
}

Eigen::Vector3d FaceProjection::weights(const Eigen::Vector3d& point) const {
  Eigen::Vector3d all;
  for (int k = 0; k < 3; ++k) all[k] = gradients_[k].dot(point - corners_[(k + 1) % 3]);
  return all;
}

Eigen::Vector3d FaceProjection::barycentric(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d all = weights(point);
  return all / all.sum();
}

Eigen::Vector3d FaceProjection::on_face(const Eigen::Vector3d& barycentric) const {
  return barycentric[0] * corners_[0] + barycentric[1] * corners_[1] + barycentric[2] * corners_[2];
}

Eigen::Vector3d FaceProjection::away(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d image = barycentric(point);
  return directions_ * Eigen::Vector3d(growth_ * image[0], growth_ * image[1], 1);
}

double lift(double image, double ratio) { return image / (ratio * (1 - image) + image); }

}  // namespace drape::model
