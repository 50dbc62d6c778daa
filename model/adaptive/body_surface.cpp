#include "model/adaptive/body_surface.hpp"

#include <fmt/format.h>

#include <string_view>

namespace drape::model {
namespace {

constexpr std::string_view endless = "plane";
constexpr double no_plane = 0;

/// [s]: of the times whose positions give velocities, short beside any step and long beside round-off.
constexpr double moment = 1e-6;

TriangleMesh mesh_of(const Polygons& polygons, const std::string& name) {
  TriangleMesh mesh{name, polygons.vertices, {}};
  for (const std::vector<int>& face : polygons.faces)
    for (std::size_t k = 2; k < face.size(); ++k) mesh.triangles.push_back({face[0], face[k - 1], face[k]});
  const PseudoNormals closed(mesh);
  turn_outward(mesh);
  require_volume(mesh);
  return mesh;
}

}  // namespace

BodySurface::BodySurface(std::span<const ObstacleRule> obstacles) : mesh_{"obstacles", {}, {}} {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles[k].kind->name == endless) continue;
    const PosedObstacle& body = bodies_.emplace_back(obstacles[k], no_plane);
    const TriangleMesh mesh =
        mesh_of(body.at(obstacles[k].motion.front().t), fmt::format("obstacles[{}] ({})", k, obstacles[k].kind->name));
    const int first = static_cast<int>(mesh_.vertices.size());
    for (const auto& [a, b, c] : mesh.triangles) mesh_.triangles.push_back({first + a, first + b, first + c});
    mesh_.vertices.insert(mesh_.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    moves_ = moves_ || moves(obstacles[k]);
  }
}

void BodySurface::place(double t, std::vector<Eigen::Vector3d>& positions) const {
  positions.clear();
  for (const PosedObstacle& body : bodies_) body.add_vertices(t, positions);
}

void BodySurface::place(double t, std::vector<Eigen::Vector3d>& positions, std::vector<Eigen::Vector3d>& velocities) const {
  velocities.clear();
  if (moves_) place(t + moment, velocities);
  place(t, positions);
  for (std::size_t k = 0; k < velocities.size(); ++k) velocities[k] = (velocities[k] - positions[k]) / moment;
}

}  // namespace drape::model
