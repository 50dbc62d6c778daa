#pragma once

#include "model/obstacles/obstacle.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// A sheet as quadrilaterals, one for each cell, a chain as lines. Vertices are the particles.
Polygons sheet_polygons(const Grid& grid, const solver::Vectors& x);

/// An obstacle with its surface, as ShapeRule has it.
class PosedObstacle {
 public:
  PosedObstacle(const ObstacleRule& rule, double plane_side) : obstacle_(rule), surface_(rule.shape->surface(plane_side)) {}

  /// The surface where it is at a time [s].
  Polygons at(double t) const;

 private:
  Obstacle obstacle_;
  Polygons surface_;
};

}  // namespace drape::model
