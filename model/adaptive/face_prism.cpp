#include "model/adaptive/face_prism.hpp"

#include <algorithm>
#include <cmath>

namespace drape::model {
namespace {

using Eigen::Vector3d;
using solver::Vectors;

Corners corners_of(const EdgeMesh& sheet, const Vectors& x, int face) {
  const auto& [a, b, c] = sheet.triangles()[face];
  return {x.row(a), x.row(b), x.row(c)};
}

/// Positive in the first triangle of the edge.
Vector3d normal_between(const EdgeMesh& sheet, const Vectors& x, const EdgeMesh::Edge& edge) {
  const auto& [one, other] = edge.triangles;
  const Vector3d first = face_normal(corners_of(sheet, x, one));
  const Vector3d second = other < 0 ? first : face_normal(corners_of(sheet, x, other));
  return separating_normal(x.row(edge.ends[1]) - x.row(edge.ends[0]), first, second);
}

}  // namespace

FacePrism::FacePrism(const EdgeMesh& sheet, const Vectors& x, int face)
    : planes_([&] {
        const Corners corners = corners_of(sheet, x, face);
        std::array<Plane, planes> all;
        all[base] = {corners[0], face_normal(corners), 1};
        for (int k = 0; k < 3; ++k) {
          const EdgeMesh::Edge& edge = sheet.edges()[sheet.sides(face)[k]];
          all[first_side + k] = {x.row(edge.ends[0]), normal_between(sheet, x, edge), edge.triangles[0] == face ? 1.0 : -1.0};
        }
        return all;
      }()),
      projection_(corners_of(sheet, x, face), {planes_[1].sign * planes_[1].normal, planes_[2].sign * planes_[2].normal,
                                               planes_[3].sign * planes_[3].normal}) {}

Eigen::Vector4d FacePrism::distances(const Vector3d& point) const {
  Eigen::Vector4d all;
  for (int k = 0; k < planes; ++k) {
    const double distance = planes_[k].normal.dot(point - planes_[k].origin);
    all[k] = std::abs(distance) <= on_plane ? 0 : planes_[k].sign * distance;
  }
  return all;
}

std::optional<FacePrism::Part> FacePrism::clip(const Eigen::Vector4d& from, const Eigen::Vector4d& to) {
  Part part;
  for (int k = 0; k < planes; ++k) {
    const bool in_plane = from[k] == 0 && to[k] == 0;
    if (in_plane && k != base) continue;
    if (from[k] <= 0 && to[k] <= 0) return {};
    const double cut = from[k] / (from[k] - to[k]);
    if (from[k] < 0 && cut > part.begin) part.begin = cut, part.begin_plane = k;
    if (to[k] < 0 && cut < part.end) part.end = cut, part.end_plane = k;
  }
  return part.begin < part.end ? std::optional(part) : std::nullopt;
}

unsigned FacePrism::sides_inside(const std::array<Eigen::Vector4d, 3>& corners) {
  // Sutherland and Hodgman's algorithm on distances, which are linear in the triangle: each plane adds a corner at most.
  struct Corner {
    Eigen::Vector4d distances;
    unsigned side;  ///< from here to the next corner
  };
  struct Polygon {
    std::array<Corner, 3 + planes> corners;
    int size = 0;
    void add(const Eigen::Vector4d& distances, unsigned side) { corners[size++] = {distances, side}; }
  };
  Polygon inside;
  for (int k = 0; k < 3; ++k) inside.add(corners[k], 1U << k);
  for (int k = 0; k < planes; ++k) {
    if (std::ranges::all_of(corners, [k](const Eigen::Vector4d& distances) { return distances[k] >= 0; })) continue;
    Polygon cut;
    for (int c = 0; c < inside.size; ++c) {
      const Corner &from = inside.corners[c], &to = inside.corners[(c + 1) % inside.size];
      const double a = from.distances[k], b = to.distances[k];
      if (a >= 0) cut.add(from.distances, from.side);
      if ((a < 0) == (b < 0)) continue;
      Eigen::Vector4d at = from.distances + a / (a - b) * (to.distances - from.distances);
      at[k] = 0;
      cut.add(at, a < 0 ? from.side : 8U << k);
    }
    inside = cut;
  }
  unsigned sides = 0;
  bool above = false;
  for (int c = 0; c < inside.size; ++c) {
    sides |= inside.corners[c].side;
    above |= inside.corners[c].distances[base] > on_plane;
  }
  return above ? sides : 0;
}

}  // namespace drape::model
