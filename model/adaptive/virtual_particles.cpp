#include "model/adaptive/virtual_particles.hpp"

#include <algorithm>
#include <array>

#include "model/adaptive/surface_march.hpp"
#include "model/collision/exact_intersection.hpp"

namespace drape::model {
namespace {

using Eigen::Vector3d;
using solver::Vectors;

std::vector<Corners> corners_at(const EdgeMesh& mesh, const auto& position) {
  std::vector<Corners> all;
  all.reserve(mesh.triangles().size());
  for (const auto& [a, b, c] : mesh.triangles()) all.push_back({position(a), position(b), position(c)});
  return all;
}

auto rows_of(const Vectors& x) {
  return [&x](int node) { return Vector3d(x.row(node)); };
}

auto items_of(std::span<const Vector3d> vertices) {
  return [vertices](int vertex) { return vertices[vertex]; };
}

/// The mesh, if it bounds a volume.
const TriangleMesh& checked(const TriangleMesh& mesh) {
  const PseudoNormals closed(mesh);
  require_volume(mesh);
  return mesh;
}

}  // namespace

VirtualParticles::VirtualParticles(std::span<const std::array<int, 3>> faces, const Vectors& places,
                                   const TriangleMesh& obstacle, solver::Counters& work)
    : sheet_("the sheet", faces),
      obstacle_(checked(obstacle).name, obstacle.triangles),
      sheet_tree_(centres_of(corners_at(sheet_, rows_of(places)))),
      obstacle_tree_(centres_of(corners_at(obstacle_, items_of(obstacle.vertices)))),
      pairs_(work.counter("adaptive_pairs", "pairs of triangles of the sheet and the obstacle that were intersected")),
      steps_(work.counter("adaptive_steps", "triangles of the obstacle that were clipped by a prism of the sheet")) {}

/// Costs nothing while the obstacle rests.
void VirtualParticles::move_obstacle(std::span<const Vector3d> vertices) {
  if (std::ranges::equal(vertices, vertices_)) return;
  vertices_.assign(vertices.begin(), vertices.end());
  body_ = corners_at(obstacle_, items_of(vertices));
  normals_.clear();
  for (const Corners& triangle : body_) normals_.push_back(face_normal(triangle));
  obstacle_tree_.refit(boxes_of(body_));
}

Insertion VirtualParticles::find(const Vectors& x, std::span<const Vector3d> vertices) {
  const std::vector<Corners> cloth = corners_at(sheet_, rows_of(x));
  sheet_tree_.refit(boxes_of(cloth));
  move_obstacle(vertices);
  std::pmr::monotonic_buffer_resource memory(&memory_);
  std::pmr::vector<std::array<int, 2>> near(&memory);
  sheet_tree_.overlapping_pairs(obstacle_tree_, [&](int face, int triangle) { near.push_back({face, triangle}); });
  std::ranges::sort(near);  // so that the order of particles does not depend on the trees
  FacePrisms prisms(sheet_, x);
  SurfaceMarch march(prisms, obstacle_, vertices, normals_, memory, steps_);
  for (const auto& [face, triangle] : near) {
    if (!march.can_enter(face, triangle)) continue;
    ++pairs_;
    if (intersect(cloth[face], body_[triangle])) march.enter(face, triangle);
  }
  return march.insertion();
}

}  // namespace drape::model
