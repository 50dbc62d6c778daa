#include "model/adaptive/body_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

#include "model/collision/box_tree.hpp"
#include "model/collision/exact_intersection.hpp"
#include "solver/base/disjoint_sets.hpp"

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

/// For each triangle the number of its body, by which triangles with common vertices are joined; in the order of the triangles.
std::vector<int> bodies_of(const TriangleMesh& mesh) {
  base::DisjointSets joined(static_cast<int>(mesh.vertices.size()));
  for (const auto& [a, b, c] : mesh.triangles) joined.join(a, b), joined.join(a, c);
  std::map<int, int> numbers;
  std::vector<int> bodies;
  for (const auto& triangle : mesh.triangles)
    bodies.push_back(numbers.try_emplace(joined.root(triangle[0]), static_cast<int>(numbers.size())).first->second);
  return bodies;
}

/// `owners`: the obstacle of each triangle, ascending; `name`: of an obstacle's body, of which it has 0, 1, …
void require_apart(const TriangleMesh& mesh, const std::vector<int>& owners, const auto& name) {
  const std::vector<int> bodies = bodies_of(mesh);
  std::vector<Corners> triangles;
  for (const auto& triangle : mesh.triangles) triangles.push_back(corners(mesh, triangle));
  BoxTree tree(centres_of(triangles));
  tree.refit(boxes_of(triangles));
  const auto named = [&](int triangle) {
    const int owner = owners[triangle];
    const auto first = std::ranges::lower_bound(owners, owner) - owners.begin();
    return name(owner, bodies[triangle] - bodies[first]);
  };
  tree.overlapping_pairs([&](int i, int j) {
    if (bodies[i] == bodies[j] || !intersect(triangles[i], triangles[j])) return;
    throw std::invalid_argument(
        fmt::format("contact.adaptive: expected bodies that do not touch, {} and {} do", named(i), named(j)));
  });
}

}  // namespace

BodySurface::BodySurface(std::span<const ObstacleRule> obstacles) : mesh_{"obstacles", {}, {}} {
  std::vector<int> owners;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const ObstacleRule& rule = obstacles[k];
    if (rule.kind->name == endless) continue;
    try {
      add(rule);
      owners.resize(mesh_.triangles.size(), static_cast<int>(k));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("obstacles[{}] ({}): {}", k, rule.kind->name, error.what()));
    }
  }
  require_apart(mesh_, owners, [&](int owner, int body) {
    return fmt::format("body {} of obstacles[{}] ({})", body, owner, obstacles[owner].kind->name);
  });
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
