#include "model/adaptive/surface_march.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace drape::model {
namespace {

using Eigen::Vector3d;

constexpr double no_angle = 1e-9;  // [rad], far above rounding, far below the angles of meshes

}  // namespace

void SurfaceMarch::enter(int face, int triangle) {
  if (!comes_from_behind(face, triangle)) return;
  go_to(face, triangle);
  while (!ahead_.empty()) {
    const auto [next_face, next_triangle] = ahead_.back();
    ahead_.pop_back();
    visit(next_face, next_triangle);
  }
}

/// Whether a triangle, or one across an edge that lies in the plane of the face, is behind the plane somewhere.
bool SurfaceMarch::comes_from_behind(int face, int triangle) {
  const auto height = [&](int vertex) { return prisms_.of(face).distances(vertices_[vertex])[FacePrism::base]; };
  const auto is_behind = [&](int other) {
    return std::ranges::any_of(obstacle_.triangles()[other], [&](int vertex) { return height(vertex) < 0; });
  };
  return is_behind(triangle) || std::ranges::any_of(obstacle_.sides(triangle), [&](int edge) {
           const auto& [from, to] = obstacle_.edges()[edge].ends;
           return height(from) == 0 && height(to) == 0 && is_behind(obstacle_.across(edge, triangle));
         });
}

void SurfaceMarch::go_to(int face, int triangle) {
  if (face >= 0 && known_.insert({face, triangle}).second) ahead_.emplace_back(face, triangle);
}

void SurfaceMarch::visit(int face, int triangle) {
  ++steps_;
  const FacePrism::Polygon inside = prisms_.of(face).clip(corners(triangle));
  for (const int side : inside.sides) {
    constexpr int first = 3 + FacePrism::first_side;
    if (side < 3)
      pass(face, triangle, obstacle_.sides(triangle)[side]);
    else if (side >= first)
      go_to(prisms_.sheet().across(prisms_.sheet().sides(face)[side - first], face), triangle);
  }
}

/// Inserts an edge of the triangle, and goes on over it and where it leaves the prism.
void SurfaceMarch::pass(int face, int triangle, int edge) {
  const FacePrism& prism = prisms_.of(face);
  const auto& [begin, end] = obstacle_.edges()[edge].ends;
  const Vector3d &x = vertices_[begin], &y = vertices_[end];
  const Eigen::Vector4d from = prism.distances(x), to = prism.distances(y);
  const auto part = FacePrism::clip(from, to);
  if (!part) return;

  const int other = obstacle_.across(edge, triangle);
  const Vector3d middle = x + 0.5 * (part->begin + part->end) * (y - x);
  const bool upper = is_upper(face, triangle, middle), other_is_upper = is_upper(face, other, middle);
  const Vector3d n = face_normal(corners(triangle)), m = face_normal(corners(other));
  const double bend = (obstacle_.edges()[edge].triangles[0] == triangle ? 1 : -1) * n.cross(m).dot((y - x).normalized());
  const bool flat = n.cross(m).norm() <= no_angle && n.dot(m) > 0, convex = flat || bend > 0;
  if (!flat && (upper || other_is_upper) && inserted_.insert({face, edge}).second) insert(face, edge, *part);

  const bool goes_on = other_is_upper ? upper || convex : !upper && convex;
  if (goes_on) go_to(face, other);
  for (int k = 0; k < 3; ++k) {
    const int plane = FacePrism::first_side + k;
    const bool touches = part->begin_plane == plane || part->end_plane == plane ||
                         (part->begin_plane < 0 && from[plane] == 0) || (part->end_plane < 0 && to[plane] == 0);
    if (!touches) continue;
    const int neighbour = prisms_.sheet().across(prisms_.sheet().sides(face)[k], face);
    go_to(neighbour, triangle);
    if (goes_on) go_to(neighbour, other);
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
  return is_upper(neighbour, one, particle.position) || is_upper(neighbour, other, particle.position);
}

Corners SurfaceMarch::corners(int triangle) const {
  const auto& [a, b, c] = obstacle_.triangles()[triangle];
  return {vertices_[a], vertices_[b], vertices_[c]};
}

bool SurfaceMarch::is_upper(int face, int triangle, const Vector3d& at) {
  return face_normal(corners(triangle)).dot(prisms_.of(face).projection().away(at)) > no_angle;
}

}  // namespace drape::model
