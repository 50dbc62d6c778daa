#include "model/sheet/normals.hpp"

#include <algorithm>
#include <utility>

namespace drape::model {

Normals::Normals(const Grid& grid) : grid_(grid) {
  if (!grid.is_cut()) return;
  const Metric metric(grid);
  std::vector<Neighbours> found;
  for (int i = 0; i < grid.particles(); ++i) {
    const Neighbours cloth = metric.neighbours(i % grid.nu, i / grid.nu);
    found.push_back(metric.area(i) > 0 ? cloth : neighbours(i));  // what is outside has some normal as well
  }
  along_cut_ = std::move(found);
}

Neighbours Normals::neighbours(int i) const {
  if (!along_cut_.empty()) return along_cut_[i];
  const int a = i % grid_.nu, b = i / grid_.nu;
  return {grid_.index(std::max(a - 1, 0), b), grid_.index(std::min(a + 1, grid_.nu - 1), b), grid_.index(a, std::max(b - 1, 0)),
          grid_.index(a, std::min(b + 1, grid_.nv - 1))};
}

Neighbours Normals::distinct(const Vectors& x, int i) const {
  Neighbours around = neighbours(i);
  if (x.row(around.left) == x.row(around.right)) around.left = i;
  if (x.row(around.lower) == x.row(around.upper)) around.lower = i;
  return around;
}

void Normals::evaluate(const Vectors& x, Vectors& n) const {
  const auto cross = [&](const Neighbours& at) -> Eigen::RowVector3d {
    return (x.row(at.right) - x.row(at.left)).cross(x.row(at.upper) - x.row(at.lower));
  };
  for (int i = 0; i < grid_.particles(); ++i) {
    n.row(i) = cross(neighbours(i));
    double length = n.row(i).norm();
    if (length == 0) n.row(i) = cross(distinct(x, i)), length = n.row(i).norm();
    n.row(i) /= length;
  }
}

std::array<std::pair<int, Eigen::Matrix3d>, 4> Normals::derivative(const Vectors& x, int i) const {
  const auto [left, right, lower, upper] = distinct(x, i);
  const Eigen::Vector3d tu = x.row(right) - x.row(left), tv = x.row(upper) - x.row(lower);
  const Eigen::Vector3d cross = tu.cross(tv);
  const Eigen::Vector3d N = cross.normalized();
  const Eigen::Matrix3d P = (Eigen::Matrix3d::Identity() - N * N.transpose()) / cross.norm();
  const Eigen::Matrix3d by_tu = -P * cross_matrix(tv), by_tv = P * cross_matrix(tu);
  return {{{left, -by_tu}, {right, by_tu}, {lower, -by_tv}, {upper, by_tv}}};
}

}  // namespace drape::model
