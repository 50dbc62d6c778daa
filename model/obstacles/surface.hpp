#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/obstacles/obstacle.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// A sheet as quadrilaterals, one for each cell, a chain as lines. Vertices are the particles.
Polygons sheet_polygons(const Grid& grid, const solver::Vectors& x);

/// The vertices of a surface of an obstacle or of its part, which ShapeRule has, at a time [s] in its own frame.
std::vector<Eigen::Vector3d> vertices_at(const Obstacle& obstacle, const Polygons& surface, double t);

/// An obstacle with its surface, as ShapeRule has it.
class PosedObstacle {
 public:
  PosedObstacle(const ObstacleRule& rule, double plane_side);

  /// The surface where it is at a time [s].
  Polygons at(double t) const;

  /// Appends the vertices of that.
  void add_vertices(double t, std::vector<Eigen::Vector3d>& all) const;

 private:
  struct Part {
    Obstacle obstacle;
    Polygons surface;
  };
  std::vector<Part> parts_;  ///< one unless they move
};

}  // namespace drape::model
