#include "model/obstacles/surface.hpp"

#include "model/obstacles/posed_mesh.hpp"
#include "model/sheet/cells.hpp"

namespace drape::model {

Polygons sheet_polygons(const Grid& grid, const solver::Vectors& x) {
  Polygons polygons;
  for (Eigen::Index i = 0; i < x.rows(); ++i) polygons.vertices.emplace_back(x.row(i));
  for (const Cell& cell : cells(grid))
    polygons.faces.push_back({cell.corner[0][0], cell.corner[1][0], cell.corner[1][1], cell.corner[0][1]});
  if (polygons.faces.empty())
    for (const Edge& edge : edges(grid)) polygons.faces.push_back({edge.i, edge.j});
  return polygons;
}

std::vector<Eigen::Vector3d> vertices_at(const Obstacle& obstacle, const Polygons& surface, double t) {
  std::vector<Eigen::Vector3d> vertices = surface.vertices;
  if (const PosedMesh* mesh = obstacle.deforming()) mesh->moving().place(t, vertices);
  return vertices;
}

PosedObstacle::PosedObstacle(const ObstacleRule& rule, double plane_side) {
  if (!rule.shape->moves()) {
    parts_.push_back({Obstacle(rule), rule.shape->surface(plane_side)});
    return;
  }
  for (Obstacle& part : parts_of(rule)) parts_.push_back({part, rule.shape->surface_of_part(parts_.size(), plane_side)});
}

Polygons PosedObstacle::at(double t) const {
  Polygons posed;
  add_vertices(t, posed.vertices);
  int first = 0;
  for (const auto& [obstacle, surface] : parts_) {
    for (std::vector<int> face : surface.faces) {
      for (int& corner : face) corner += first;
      posed.faces.push_back(std::move(face));
    }
    first += static_cast<int>(surface.vertices.size());
  }
  return posed;
}

void PosedObstacle::add_vertices(double t, std::vector<Eigen::Vector3d>& all) const {
  for (const auto& [obstacle, surface] : parts_) {
    const Pose pose = obstacle.pose(t);
    for (const Eigen::Vector3d& vertex : vertices_at(obstacle, surface, t)) all.push_back(pose.to_world(vertex));
  }
}

}  // namespace drape::model
