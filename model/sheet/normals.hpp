#pragma once

#include <array>
#include <utility>
#include <vector>

#include "model/sheet/metric.hpp"

namespace drape::model {

/// Vertex normals N = (t_u × t_v)° of a grid, the tangents being differences of the neighbours, one-sided on borders and
/// along a cut and at the tip of a dart, whose sides are sewn together.
class Normals {
 public:
  explicit Normals(const Grid& grid);

  /// Sets n (N × 3). NaN where the tangents are parallel.
  void evaluate(const Vectors& x, Vectors& n) const;

  /// The four blocks ∂N_i/∂x_j of particle i with the particles j they belong to.
  std::array<std::pair<int, Eigen::Matrix3d>, 4> derivative(const Vectors& x, int i) const;

 private:
  void evaluate_line(int b, const Vectors& x, Vectors& n) const;
  Neighbours neighbours(int i) const;

  /// With the particle itself in the place of a neighbour that is sewn to the one opposite.
  Neighbours distinct(const Vectors& x, int i) const;

  Grid grid_;
  std::vector<Neighbours> along_cut_;  ///< of all particles; empty if there is no cut
};

/// The matrix of a × ·.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d C;
  C << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return C;
}

/// The derivative of <q, N> N, a projection onto a normal, by that normal.
inline Eigen::Matrix3d projection_by_normal(const Eigen::Vector3d& q, const Eigen::Vector3d& N) {
  return N.dot(q) * Eigen::Matrix3d::Identity() + N * q.transpose();
}

}  // namespace drape::model
