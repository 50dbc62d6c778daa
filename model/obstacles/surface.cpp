#include "model/obstacles/surface.hpp"

#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "model/obstacles/mesh_shape.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {
namespace {

using Eigen::Vector3d;

constexpr int sides = 48;  // of a circle
constexpr int rings = 24;  // of a sphere

Polygons square(double side) {
  const double a = side / 2;
  return {{{-a, -a, 0}, {a, -a, 0}, {a, a, 0}, {-a, a, 0}}, {{0, 1, 2, 3}}};
}

Polygons faces_of_box(const Vector3d& size) {
  Polygons polygons;
  for (const double z : {-0.5, 0.5})
    for (const Vector3d& corner : square(1).vertices)
      polygons.vertices.emplace_back((corner + Vector3d(0, 0, z)).cwiseProduct(size));
  polygons.faces = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return polygons;
}

/// A point of a profile: distance from the z axis and height.
struct ProfilePoint {
  double r, z;
};

/// A profile from below to above, turned round the z axis and closed by a lid at either end.
Polygons turned(const std::vector<ProfilePoint>& profile) {
  Polygons polygons;
  for (const auto& [r, z] : profile)
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      polygons.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  const int last = static_cast<int>(polygons.vertices.size()) - sides;
  for (int ring = 0; ring < last; ring += sides)
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      polygons.faces.push_back({ring + k, ring + next, ring + sides + next, ring + sides + k});
    }
  std::vector<int> lid(sides);
  std::iota(lid.begin(), lid.end(), last);
  polygons.faces.push_back(lid);
  std::iota(lid.rbegin(), lid.rend(), 0);
  polygons.faces.push_back(lid);
  return polygons;
}

Polygons faces_of_sphere(double radius) {
  std::vector<ProfilePoint> profile;
  for (int k = 0; k < rings; ++k) {
    const double angle = std::numbers::pi * (k + 0.5) / rings;
    profile.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
  }
  return turned(profile);
}

Polygons mesh(const std::string& file, double scale) {
  const TriangleMesh triangles = read_mesh(file);
  Polygons polygons;
  for (const Vector3d& vertex : triangles.vertices) polygons.vertices.emplace_back(scale * vertex);
  for (const auto& [a, b, c] : triangles.triangles) polygons.faces.push_back({a, b, c});
  return polygons;
}

}  // namespace

Polygons sheet_polygons(const Grid& grid, const solver::Vectors& x) {
  Polygons polygons;
  for (Eigen::Index i = 0; i < x.rows(); ++i) polygons.vertices.emplace_back(x.row(i));
  for (const Cell& cell : cells(grid))
    polygons.faces.push_back({cell.corner[0][0], cell.corner[1][0], cell.corner[1][1], cell.corner[0][1]});
  if (polygons.faces.empty())
    for (const Edge& edge : edges(grid)) polygons.faces.push_back({edge.i, edge.j});
  return polygons;
}

Polygons obstacle_polygons(const ObstacleRule& rule, double plane_side) {
  switch (rule.kind) {
    case ShapeKind::plane: return square(plane_side);
    case ShapeKind::sphere: return faces_of_sphere(rule.radius);
    case ShapeKind::box: return faces_of_box(rule.size);
    case ShapeKind::cylinder: return turned({{rule.radius, -rule.height / 2}, {rule.radius, rule.height / 2}});
    case ShapeKind::mesh: return mesh(rule.file, rule.scale);
  }
  throw std::invalid_argument("unknown shape of an obstacle");
}

Polygons PosedObstacle::at(double t) const {
  Polygons posed = surface_;
  const Pose pose = obstacle_.pose(t);
  for (Vector3d& vertex : posed.vertices) vertex = pose.to_world(vertex);
  return posed;
}

void write_obj(std::ostream& out, const Polygons& polygons) {
  for (const Vector3d& v : polygons.vertices) fmt::print(out, "v {} {} {}\n", v[0], v[1], v[2]);
  for (std::vector<int> corners : polygons.faces) {
    for (int& corner : corners) ++corner;  // OBJ counts from 1
    fmt::print(out, "{} {}\n", corners.size() > 2 ? 'f' : 'l', fmt::join(corners, " "));
  }
}

}  // namespace drape::model
