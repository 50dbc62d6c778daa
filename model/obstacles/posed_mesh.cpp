#include "model/obstacles/posed_mesh.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

namespace drape::model {

using Eigen::Vector3d;

PosedMesh::PosedMesh(std::shared_ptr<const MovingMesh> mesh)
    : moving_(std::move(mesh)),
      t_(moving_->within(-std::numeric_limits<double>::infinity())),
      within_(t_),
      mesh_(moving_->first()),
      hierarchy_(mesh_) {}

void PosedMesh::set_time(double t) {
  t_ = t;
  const double within = moving_->within(t);
  if (std::exchange(within_, within) == within) return;
  moving_->place(within, mesh_.vertices);
  hierarchy_.refit(mesh_);
}

Nearest PosedMesh::nearest(const Vector3d& p, const TriangleHierarchy::Found& found) const {
  const auto& [point, part] = found.nearest;
  const Vector3d n = moving_->normals().at(mesh_, found.triangle, part), away = p - point;
  if (part == face_part) return {n.dot(away), n};
  const double distance = std::copysign(away.norm(), n.dot(away));
  // On the surface p and the nearest point differ by round-off, which has no direction.
  if (std::abs(distance) <= 1e-10 * moving_->extent()) return {distance, n};
  return {distance, away / distance};
}

Nearest PosedMesh::nearest(const Vector3d& p) const { return nearest(p, hierarchy_.nearest(p)); }

PosedMesh::Touch PosedMesh::touch(const Vector3d& p) const {
  const TriangleHierarchy::Found found = hierarchy_.nearest(p);
  const Corners at = corners(mesh_, mesh_.triangles[found.triangle]);
  return {nearest(p, found), {found.triangle, barycentric(at, found.nearest)}};
}

Pose PosedMesh::pose(const MaterialPoint& at) const {
  const Corners c = corners(mesh_, mesh_.triangles[at.triangle]);
  Eigen::Matrix3d axes;
  axes.col(0) = (c[1] - c[0]).normalized();
  axes.col(2) = face_normal(c);
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {at.weights[0] * c[0] + at.weights[1] * c[1] + at.weights[2] * c[2], Eigen::Quaterniond(axes)};
}

Vector3d PosedMesh::velocity(const MaterialPoint& at) const {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) sum += at.weights[k] * moving_->velocity(t_, mesh_.triangles[at.triangle][k]);
  return sum;
}

}  // namespace drape::model
