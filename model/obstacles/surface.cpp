#include "model/obstacles/surface.hpp"

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

Polygons PosedObstacle::at(double t) const {
  Polygons posed = surface_;
  const Pose pose = obstacle_.pose(t);
  for (Eigen::Vector3d& vertex : posed.vertices) vertex = pose.to_world(vertex);
  return posed;
}

}  // namespace drape::model
