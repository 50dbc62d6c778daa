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

/// The part of a way after which it comes into a box that is larger by `margin` on all sides; infinite if it does not.
double part_to_box(const AlignedBox3d& box, const Vector3d& from, const Vector3d& way, double margin) {
  constexpr double never = std::numeric_limits<double>::infinity();
  double in = 0, out = 1;
  for (int c = 0; c < 3; ++c) {
    const double low = box.min()[c] - margin - from[c], high = box.max()[c] + margin - from[c];
    if (way[c] == 0) {
      if (low > 0 || high < 0) return never;
      continue;
    }
    const auto [near, far] = std::minmax({low / way[c], high / way[c]});
    in = std::max(in, near), out = std::min(out, far);
  }
  return in <= out ? in : never;
}

/// The same for what is within `distance` of a triangle. That is convex, and so is the distance along the way: Newton's method
/// from its beginning comes nearer to the first such place and never passes it.
double part_to_triangle(const Corners& corners, const Vector3d& from, const Vector3d& way, double distance) {
  constexpr double round_off = 1e-12;
  for (double part = 0; part <= 1;) {
    const Vector3d p = from + part * way, away = p - nearest_on_triangle(corners, p).point;
    const double r = away.norm();
    if (r <= (1 + round_off) * distance) return part;
    const double approach = -away.dot(way) / r;
    if (approach <= 0) break;
    const double next = part + (r - distance) / approach;
    if (next == part) return part;
    part = next;
  }
  return std::numeric_limits<double>::infinity();
}

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

std::optional<double> TriangleHierarchy::first_within(const Vector3d& from, const Vector3d& to, double distance,
                                                      std::int64_t& boxes) const {
  const Vector3d way = to - from;
  struct Pending {
    int node;
    double part;
  };
  const auto pending_at = [&](int node) { return Pending{node, part_to_box(nodes_[node].box, from, way, distance)}; };
  std::array<Pending, most_pending> pending{pending_at(0)};
  int count = 1;
  double first = std::numeric_limits<double>::infinity();
  while (count > 0) {
    const auto [at, part] = pending[--count];
    if (part >= first) continue;
    ++boxes;
    const Node& node = nodes_[at];
    if (node.right > 0) {
      Pending near = pending_at(at + 1), far = pending_at(node.right);
      if (far.part < near.part) std::swap(near, far);
      pending[count++] = far;
      pending[count++] = near;
      continue;
    }
    for (int k = node.begin; k < node.end; ++k) first = std::min(first, part_to_triangle(corners_[k], from, way, distance));
  }
  return first <= 1 ? std::optional(first) : std::nullopt;
}

}  // namespace drape::model
