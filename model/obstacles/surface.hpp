#pragma once

#include <iosfwd>
#include <vector>

#include "model/obstacles/obstacle.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// A mesh of polygons, for looking at.
struct Polygons {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<int>> faces;  ///< corners of a polygon, or the two ends of a line
};

/// A sheet as quadrilaterals, one for each cell, a chain as lines. Vertices are the particles.
Polygons sheet_polygons(const Grid& grid, const solver::Vectors& x);

/// The surface of an obstacle in its own frame; of a plane a square with the given side [m]. Throws as Obstacle does.
Polygons obstacle_polygons(const ObstacleRule& rule, double plane_side);

/// An obstacle with its surface, as obstacle_polygons() has it.
class PosedObstacle {
 public:
  PosedObstacle(const ObstacleRule& rule, double plane_side) : obstacle_(rule), surface_(obstacle_polygons(rule, plane_side)) {}

  /// The surface where it is at a time [s].
  Polygons at(double t) const;

 private:
  Obstacle obstacle_;
  Polygons surface_;
};

/// In Wavefront's OBJ format, numbers to the last bit.
void write_obj(std::ostream& out, const Polygons& polygons);

}  // namespace drape::model
