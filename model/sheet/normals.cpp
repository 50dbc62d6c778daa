#include "model/sheet/normals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "solver/base/threads.hpp"

namespace drape::model {
namespace {

/// x y z x y z … of the neighbours of consecutive particles.
struct AroundLine {
  const double *left, *right, *lower, *upper;
};

/// The normals of consecutive particles, by a loop that vectorises; false if one has none.
bool normals_inside(AroundLine x, int count, double* n) {
  int missing = 0;
#pragma GCC ivdep
  for (int k = 0; k < 3 * count; k += 3) {
    const double ux = x.right[k] - x.left[k], uy = x.right[k + 1] - x.left[k + 1], uz = x.right[k + 2] - x.left[k + 2];
    const double vx = x.upper[k] - x.lower[k], vy = x.upper[k + 1] - x.lower[k + 1], vz = x.upper[k + 2] - x.lower[k + 2];
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
    missing |= static_cast<int>(length == 0);
    n[k] = nx / length;
    n[k + 1] = ny / length;
    n[k + 2] = nz / length;
  }
  return missing == 0;
}

}  // namespace

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
  base::each_in_parts(base::threads_for(grid_.particles()), grid_.nv,
                      [&](std::int64_t b) { evaluate_line(static_cast<int>(b), x, n); });
}

void Normals::evaluate_line(int b, const Vectors& x, Vectors& n) const {
  const auto cross = [&](const Neighbours& at) -> Eigen::RowVector3d {
    return (x.row(at.right) - x.row(at.left)).cross(x.row(at.upper) - x.row(at.lower));
  };
  const auto evaluate_at = [&](int i) {
    n.row(i) = cross(neighbours(i));
    double length = n.row(i).norm();
    if (length == 0) n.row(i) = cross(distinct(x, i)), length = n.row(i).norm();
    n.row(i) /= length;
  };
  const auto at = [&](int a, int line) { return x.data() + 3 * static_cast<std::ptrdiff_t>(grid_.index(a, line)); };
  const int first = grid_.index(0, b);
  if (grid_.nu > 2 && along_cut_.empty() &&
      normals_inside({at(0, b), at(2, b), at(1, std::max(b - 1, 0)), at(1, std::min(b + 1, grid_.nv - 1))}, grid_.nu - 2,
                     n.data() + 3 * static_cast<std::ptrdiff_t>(first + 1))) {
    evaluate_at(first);
    evaluate_at(first + grid_.nu - 1);
  } else {
    for (int a = 0; a < grid_.nu; ++a) evaluate_at(first + a);
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
