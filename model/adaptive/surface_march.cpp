#include "model/adaptive/surface_march.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace drape::model {
namespace {

using Eigen::Vector3d;

constexpr double no_angle = 1e-9;  // [rad], far above rounding, far below the angles of meshes

}  // namespace

SurfaceMarch::SurfaceMarch(FacePrisms& prisms, const EdgeMesh& obstacle, std::span<const Vector3d> vertices,
                           std::span<const Vector3d> normals, std::pmr::memory_resource& memory, std::int64_t& steps)
    : prisms_(prisms),
      obstacle_(obstacle),
      vertices_(vertices),
      steps_(steps),
      normals_(normals),
      draft_(prisms, memory),
      known_(&memory),
      inserted_(&memory),
      ahead_(&memory) {}

bool SurfaceMarch::can_enter(int face, int triangle) {
  if (known_.contains(place(face, triangle))) return false;
  const FacePrism& prism = prisms_.of(face);
  const auto height = [&](int vertex) { return prism.distances(vertices_[vertex])[FacePrism::base]; };
  const auto is_in_front = [&](int vertex) { return height(vertex) > 0; };
  const auto is_behind = [&](int vertex) { return height(vertex) < 0; };
  const auto& corners = obstacle_.triangles()[triangle];
  if (std::ranges::none_of(corners, is_in_front)) return false;
  if (std::ranges::any_of(corners, is_behind)) return true;
  // A side may lie in the plane of the face, and the obstacle go on behind it.
  return std::ranges::any_of(obstacle_.sides(triangle), [&](int edge) {
    const auto& [from, to] = obstacle_.edges()[edge].ends;
    return height(from) == 0 && height(to) == 0 &&
           std::ranges::any_of(obstacle_.triangles()[obstacle_.across(edge, triangle)], is_behind);
  });
}

void SurfaceMarch::enter(int face, int triangle) {
  go_to(face, triangle);
  while (!ahead_.empty()) {
    const auto [next_face, next_triangle] = ahead_.back();
    ahead_.pop_back();
    visit(next_face, next_triangle);
  }
}

void SurfaceMarch::go_to(int face, int triangle) {
  if (face >= 0 && known_.insert(place(face, triangle)).second) ahead_.emplace_back(face, triangle);
}

void SurfaceMarch::visit(int face, int triangle) {
  ++steps_;
  std::array<Eigen::Vector4d, 3> distances;
  for (int k = 0; k < 3; ++k) distances[k] = prisms_.of(face).distances(vertices_[obstacle_.triangles()[triangle][k]]);
  const unsigned sides = FacePrism::sides_inside(distances);
  for (int k = 0; k < 3; ++k) {
    if ((sides >> k & 1U) != 0) pass(face, triangle, k, distances[k], distances[(k + 1) % 3]);
    if ((sides >> (3 + FacePrism::first_side + k) & 1U) != 0) go_to(neighbour(face, k), triangle);
  }
}

/// Inserts a side of the triangle, with these distances of its ends, and goes on over it and where it leaves the prism.
void SurfaceMarch::pass(int face, int triangle, int side, const Eigen::Vector4d& from, const Eigen::Vector4d& to) {
  const int edge = obstacle_.sides(triangle)[side], other = obstacle_.across(edge, triangle);
  const bool forward = obstacle_.edges()[edge].triangles[0] == triangle;
  const auto part = forward ? FacePrism::clip(from, to) : FacePrism::clip(to, from);
  if (!part) return;

  const auto& [begin, end] = obstacle_.edges()[edge].ends;
  const Vector3d &x = vertices_[begin], &y = vertices_[end], &n = normals_[triangle], &m = normals_[other];
  const Vector3d away = prisms_.of(face).projection().away(x + 0.5 * (part->begin + part->end) * (y - x));
  const bool upper = is_upper(triangle, away), other_is_upper = is_upper(other, away);
  const Vector3d bend = n.cross(m);
  const bool flat = bend.norm() <= no_angle && n.dot(m) > 0, convex = flat || (bend.dot(y - x) > 0) == forward;
  if (!flat && (upper || other_is_upper) && inserted_.insert(face * std::ssize(obstacle_.edges()) + edge).second)
    insert(face, edge, *part);

  const bool goes_on = other_is_upper ? upper || convex : !upper && convex;
  if (goes_on) go_to(face, other);
  for (int k = 0; k < 3; ++k) {
    const int plane = FacePrism::first_side + k;
    if (part->begin_plane != plane && part->end_plane != plane && from[plane] != 0 && to[plane] != 0) continue;
    go_to(neighbour(face, k), triangle);
    if (goes_on) go_to(neighbour(face, k), other);
  }
}

void SurfaceMarch::insert(int face, int edge, const FacePrism::Part& part) {
  const auto& ends = obstacle_.edges()[edge].ends;
  const Vector3d &x = vertices_[ends[0]], &y = vertices_[ends[1]];
  const auto end = [&](double parameter, int plane, int vertex) {
    InsertionDraft::End made{{x + parameter * (y - x), edge, parameter}, -1, plane, false};
    if (plane < 0) {
      made.vertex = vertex;
      made.particle.position = vertices_[vertex];
      // A vertex may lie on a plane between faces, also on two, above a node.
      const Eigen::Vector4d distances = prisms_.of(face).distances(vertices_[vertex]);
      for (int k = FacePrism::first_side; k < FacePrism::planes; ++k)
        if (distances[k] == 0) made.plane = k;
    }
    if (made.plane >= FacePrism::first_side)
      made.shared = is_seen_beyond(face, prisms_.sheet().sides(face)[made.plane - FacePrism::first_side], made.particle);
    return made;
  };
  draft_.add(face, end(part.begin, part.begin_plane, ends[0]), end(part.end, part.end_plane, ends[1]));
}

/// Whether the face on the other side of an edge, if there is one, sees a particle in the plane between them.
bool SurfaceMarch::is_seen_beyond(int face, int edge, const VirtualParticle& particle) {
  const int neighbour = prisms_.sheet().across(edge, face);
  if (neighbour < 0) return true;
  const auto image = prisms_.along(neighbour, edge, particle.position);
  if (!image || *image < 0 || *image > 1) return false;
  const auto& [one, other] = obstacle_.edges()[particle.edge].triangles;
  const Vector3d away = prisms_.of(neighbour).projection().away(particle.position);
  return is_upper(one, away) || is_upper(other, away);
}

bool SurfaceMarch::is_upper(int triangle, const Vector3d& away) const { return normals_[triangle].dot(away) > no_angle; }

int SurfaceMarch::neighbour(int face, int side) const {
  return prisms_.sheet().across(prisms_.sheet().sides(face)[side], face);
}

}  // namespace drape::model
