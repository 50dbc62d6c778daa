#include "model/obstacles/mesh_shape.hpp"

#include <stdexcept>
#include <utility>

#include "model/obstacles/moving_mesh.hpp"
#include "model/obstacles/posed_mesh.hpp"

namespace drape::model {
namespace {

class MeshShape : public Shape {
 public:
  explicit MeshShape(std::shared_ptr<const MovingMesh> mesh) : first_(std::move(mesh)) {}

  Nearest nearest(const Eigen::Vector3d& p) const override { return first_.nearest(p); }
  const PosedMesh* mesh() const override { return &first_; }

 private:
  PosedMesh first_;
};

}  // namespace

std::unique_ptr<const Shape> mesh_shape(KeyedMesh keyed, double scale) {
  for (Eigen::Vector3d& v : keyed.mesh.vertices) v *= scale;
  for (KeyVertices& key : keyed.keys)
    for (Eigen::Vector3d& v : key.vertices) v *= scale;
  turn_outward(keyed.mesh);
  return std::make_unique<MeshShape>(std::make_shared<MovingMesh>(std::move(keyed.mesh), std::move(keyed.keys)));
}

std::unique_ptr<const Shape> mesh_shape(const std::string& file, double scale) {
  return mesh_shape({read_mesh(file), {}}, scale);
}

std::vector<Obstacle> mesh_parts_of(const ObstacleRule& rule) {
  constexpr double no_plane = 0;
  std::vector<Obstacle> all;
  for (const Obstacle& part : parts_of(rule)) {
    if (part.deforming() != nullptr) throw std::invalid_argument("expected a rigid body, it deforms");
    const Polygons surface = rule.shape->surface_of_part(all.size(), no_plane);
    all.emplace_back(rule, all.size(), mesh_shape({{"its surface", surface.vertices, fan_triangles(surface)}, {}}, 1));
  }
  return all;
}

}  // namespace drape::model
