#include "model/adaptive/body_surface.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace drape::model {
namespace {

constexpr std::string_view endless = "plane";
constexpr double no_plane = 0;

/// [s]: of the times whose positions give velocities, short beside any step and long beside round-off.
constexpr double time_of_velocities = 1e-6;

TriangleMesh mesh_of(const Polygons& polygons) {
  TriangleMesh mesh{"its surface", polygons.vertices, fan_triangles(polygons)};
  const PseudoNormals closed(mesh);
  turn_outward(mesh);
  require_volume(mesh);
  return mesh;
}

}  // namespace

BodySurface::BodySurface(std::span<const ObstacleRule> obstacles) : mesh_{"obstacles", {}, {}} {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const ObstacleRule& rule = obstacles[k];
    if (rule.kind->name == endless) continue;
    try {
      add(rule);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("obstacles[{}] ({}): {}", k, rule.kind->name, error.what()));
    }
  }
}

void BodySurface::add(const ObstacleRule& rule) {
  const TriangleMesh mesh = mesh_of(bodies_.emplace_back(rule, no_plane).at(rule.motion.front().t));
  const int first = static_cast<int>(mesh_.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) mesh_.triangles.push_back({first + a, first + b, first + c});
  mesh_.vertices.insert(mesh_.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  moves_ = moves_ || moves(rule);
}

void BodySurface::place(double t, std::vector<Eigen::Vector3d>& positions) const {
  positions.clear();
  for (const PosedObstacle& body : bodies_) body.add_vertices(t, positions);
}

void BodySurface::place(double t, std::vector<Eigen::Vector3d>& positions, std::vector<Eigen::Vector3d>& velocities) const {
  velocities.clear();
  if (moves_) place(t + time_of_velocities, velocities);
  place(t, positions);
  for (std::size_t k = 0; k < velocities.size(); ++k) velocities[k] = (velocities[k] - positions[k]) / time_of_velocities;
}

}  // namespace drape::model
