#include "model/obstacles/triangle_hierarchy.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

namespace drape::model {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr int most_in_leaf = 4;  ///< triangles

/// Halving 2^31 triangles takes 31 levels, each of which leaves one child to be visited later.
constexpr int most_pending = 32;

}  // namespace

TriangleHierarchy::TriangleHierarchy(const TriangleMesh& mesh) : order_(mesh.triangles.size()), corners_(order_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vector3d> centres;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, triangle);
    centres.emplace_back((a + b + c) / 3);
  }
  build(0, static_cast<int>(order_.size()), centres);
  refit(mesh);
}

/// Halves the triangles where their centres spread farthest. Returns the node.
int TriangleHierarchy::build(int begin, int end, const std::vector<Vector3d>& centres) {
  const int node = static_cast<int>(nodes_.size());
  nodes_.push_back({{}, begin, end});
  if (end - begin <= most_in_leaf) return node;
  AlignedBox3d spread;
  for (int k = begin; k < end; ++k) spread.extend(centres[order_[k]]);
  Eigen::Index axis = 0;
  spread.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::ranges::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, {},
                           [&](int t) { return centres[t][axis]; });
  build(begin, middle, centres);
  const int right = build(middle, end, centres);
  nodes_[node].right = right;
  return node;
}

void TriangleHierarchy::refit(const TriangleMesh& mesh) {
  for (std::size_t k = 0; k < order_.size(); ++k) corners_[k] = corners(mesh, mesh.triangles[order_[k]]);
  for (int k = static_cast<int>(nodes_.size()) - 1; k >= 0; --k) {  // children stand behind their parents
    Node& node = nodes_[k];
    if (node.right > 0) {
      node.box = nodes_[k + 1].box.merged(nodes_[node.right].box);
      continue;
    }
    node.box.setEmpty();
    for (int t = node.begin; t < node.end; ++t)
      for (const Vector3d& corner : corners_[t]) node.box.extend(corner);
  }
}

TriangleHierarchy::Found TriangleHierarchy::nearest(const Vector3d& p) const {
  struct Pending {
    int node;
    double squared_distance;
  };
  std::array<Pending, most_pending> pending{{{0, 0}}};
  int count = 1;
  Found found{0, {Vector3d::Zero(), face_part}};
  double least = std::numeric_limits<double>::infinity();
  while (count > 0) {
    const auto [at, squared_distance] = pending[--count];
    if (squared_distance >= least) continue;
    const Node& node = nodes_[at];
    if (node.right > 0) {
      Pending near{at + 1, nodes_[at + 1].box.squaredExteriorDistance(p)};
      Pending far{node.right, nodes_[node.right].box.squaredExteriorDistance(p)};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      pending[count++] = far;
      pending[count++] = near;
      continue;
    }
    for (int k = node.begin; k < node.end; ++k) {
      const TrianglePoint candidate = nearest_on_triangle(corners_[k], p);
      const double squared = (p - candidate.point).squaredNorm();
      if (squared < least) {
        least = squared;
        found = {order_[k], candidate};
      }
    }
  }
  return found;
}

}  // namespace drape::model
