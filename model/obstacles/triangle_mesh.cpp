#include "model/obstacles/triangle_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace drape::model {
namespace {

using Eigen::Vector3d;

[[noreturn]] void fail(const TriangleMesh& mesh, const std::string& what) {
  throw std::invalid_argument(fmt::format("{}: {}", mesh.name, what));
}

/// A side of a triangle, from corner `side` to the next.
struct HalfEdge {
  int low, high;  ///< its vertices
  bool upward;    ///< from low to high
  int triangle, side;

  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// All half-edges; those of one edge are neighbours.
std::vector<HalfEdge> half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> all;
  for (int t = 0; t < std::ssize(mesh.triangles); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      all.push_back({std::min(from, to), std::max(from, to), from < to, t, k});
    }
  }
  std::ranges::sort(all, {}, [](const HalfEdge& e) { return std::tuple(e.low, e.high, e.triangle); });
  return all;
}

/// After this, half-edges 2k and 2k + 1 are the two sides of an edge.
void check_closed(const TriangleMesh& mesh, const std::vector<HalfEdge>& all) {
  std::ptrdiff_t open = 0, branching = 0, twisted = 0;
  for (auto first = all.begin(); first != all.end();) {
    const auto end = std::find_if(first, all.end(), [&](const HalfEdge& e) { return !e.same_edge(*first); });
    open += end - first == 1;
    branching += end - first > 2;
    twisted += end - first == 2 && first->upward == (first + 1)->upward;
    first = end;
  }
  const std::size_t triangles = mesh.triangles.size();
  if (open > 0) fail(mesh, fmt::format("expected a closed mesh, {} edges of its {} triangles are open", open, triangles));
  if (branching > 0) fail(mesh, fmt::format("expected edges of two triangles each, {} have more", branching));
  if (twisted > 0)
    fail(mesh, fmt::format("expected triangles that agree on which side is outside, across {} edges they do not", twisted));
}

/// Six times the enclosed volume, and the sum of its parts' magnitudes: all seen from the first vertex.
std::pair<double, double> six_volumes(const TriangleMesh& mesh) {
  double sum = 0, magnitude = 0;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    Corners c = corners(mesh, triangle);
    for (Vector3d& corner : c) corner -= mesh.vertices.front();
    const double part = c[0].cross(c[1]).dot(c[2]);
    sum += part;
    magnitude += std::abs(part);
  }
  return {sum, magnitude};
}

double angle(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// n/|n|; where faces cancel, that of one of them.
Vector3d unit(const Vector3d& n, const Vector3d& of_face) {
  constexpr double cancelled = 1e-12;
  return n.norm() > cancelled ? Vector3d(n.normalized()) : of_face;
}

}  // namespace

Corners corners(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
}

void turn_outward(TriangleMesh& mesh) {
  if (six_volumes(mesh).first >= 0) return;
  for (std::array<int, 3>& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

void require_volume(const TriangleMesh& mesh) {
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, triangle);
    const Vector3d ab = b - a, ac = c - a;
    if (ab.cross(ac).norm() <= 8 * std::numeric_limits<double>::epsilon() * ab.norm() * ac.norm())
      fail(mesh, fmt::format("expected triangles with an area, the one at ({}, {}, {}) has none", a.x(), a.y(), a.z()));
  }
  constexpr double none = 1e-12;
  const auto [volume, magnitude] = six_volumes(mesh);
  if (volume < -none * magnitude) fail(mesh, "expected a mesh that is not inside out");
  if (volume <= none * magnitude) fail(mesh, "expected a mesh that encloses a volume");
}

Vector3d face_normal(const Corners& corners) {
  const auto& [a, b, c] = corners;
  return (b - a).cross(c - a).normalized();
}

std::vector<Vector3d> centres_of(std::span<const Corners> triangles) {
  std::vector<Vector3d> all;
  all.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) all.emplace_back((a + b + c) / 3);
  return all;
}

std::vector<Eigen::AlignedBox3d> boxes_of(std::span<const Corners> triangles, double margin) {
  std::vector<Eigen::AlignedBox3d> all;
  all.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles)
    all.emplace_back(a.cwiseMin(b).cwiseMin(c).array() - margin, a.cwiseMax(b).cwiseMax(c).array() + margin);
  return all;
}

PseudoNormals::PseudoNormals(const TriangleMesh& mesh)
    : neighbours_(mesh.triangles.size()), first_(mesh.vertices.size() + 1, 0), around_(3 * mesh.triangles.size()) {
  const std::vector<HalfEdge> edges = half_edges(mesh);
  check_closed(mesh, edges);
  for (std::size_t e = 0; e < edges.size(); e += 2) {
    neighbours_[edges[e].triangle][edges[e].side] = edges[e + 1].triangle;
    neighbours_[edges[e + 1].triangle][edges[e + 1].side] = edges[e].triangle;
  }
  for (const std::array<int, 3>& triangle : mesh.triangles)
    for (const int v : triangle) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (int t = 0; t < std::ssize(mesh.triangles); ++t)
    for (const int v : mesh.triangles[t]) around_[next[v]++] = t;
}

Vector3d PseudoNormals::at(const TriangleMesh& mesh, int triangle, int part) const {
  const auto face = [&](int t) { return face_normal(corners(mesh, mesh.triangles[t])); };
  if (part == face_part) return face(triangle);
  if (part < first_corner_part) {
    const auto [one, other] = std::minmax(triangle, neighbours_[triangle][part - first_edge_part]);
    const Vector3d n = face(one);
    return unit(n + face(other), n);
  }
  const int v = mesh.triangles[triangle][part - first_corner_part];
  Vector3d sum = Vector3d::Zero();
  for (int k = first_[v]; k < first_[v + 1]; ++k) {
    const std::array<int, 3>& t = mesh.triangles[around_[k]];
    const Corners c = corners(mesh, t);
    const std::ptrdiff_t at = std::ranges::find(t, v) - t.begin();
    sum += angle(c[(at + 1) % 3] - c[at], c[(at + 2) % 3] - c[at]) * face_normal(c);
  }
  return unit(sum, face(triangle));
}

TrianglePoint nearest_on_triangle(const Corners& corners, const Vector3d& p) {
  const auto& [a, b, c] = corners;
  const auto corner = [&](int k) { return TrianglePoint{corners[k], first_corner_part + k}; };
  const auto edge = [&](int k, double part) {
    return TrianglePoint{corners[k] + part * (corners[(k + 1) % 3] - corners[k]), first_edge_part + k};
  };
  const Vector3d ab = b - a, ac = c - a;
  const double a_ab = ab.dot(p - a), a_ac = ac.dot(p - a);
  if (a_ab <= 0 && a_ac <= 0) return corner(0);
  const double b_ab = ab.dot(p - b), b_ac = ac.dot(p - b);
  if (b_ab >= 0 && b_ac <= b_ab) return corner(1);
  const double c_ab = ab.dot(p - c), c_ac = ac.dot(p - c);
  if (c_ac >= 0 && c_ab <= c_ac) return corner(2);
  // Barycentric coordinates, times a positive number: beyond an edge that of the corner opposite to it is negative.
  const double wc = a_ab * b_ac - b_ab * a_ac;
  if (wc <= 0 && a_ab >= 0 && b_ab <= 0) return edge(0, a_ab / (a_ab - b_ab));
  const double wa = b_ab * c_ac - c_ab * b_ac;
  const double b_bc = b_ac - b_ab, c_cb = c_ab - c_ac;
  if (wa <= 0 && b_bc >= 0 && c_cb >= 0) return edge(1, b_bc / (b_bc + c_cb));
  const double wb = c_ab * a_ac - a_ab * c_ac;
  if (wb <= 0 && a_ac >= 0 && c_ac <= 0) return edge(2, c_ac / (c_ac - a_ac));
  return {a + (wb * ab + wc * ac) / (wa + wb + wc), face_part};
}

Vector3d barycentric(const Corners& corners, const TrianglePoint& at) {
  if (at.part >= first_corner_part) return Vector3d::Unit(at.part - first_corner_part);
  if (at.part >= first_edge_part) {
    const int from = at.part - first_edge_part, to = (from + 1) % 3;
    const Vector3d edge = corners[to] - corners[from];
    Vector3d weights = Vector3d::Zero();
    weights[to] = edge.dot(at.point - corners[from]) / edge.squaredNorm();
    weights[from] = 1 - weights[to];
    return weights;
  }
  const auto& [a, b, c] = corners;
  const Vector3d n = (b - a).cross(c - a), ap = at.point - a;
  const double wb = ap.cross(c - a).dot(n) / n.squaredNorm(), wc = (b - a).cross(ap).dot(n) / n.squaredNorm();
  return {1 - wb - wc, wb, wc};
}

}  // namespace drape::model
