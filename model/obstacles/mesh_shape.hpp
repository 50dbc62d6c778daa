#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/obstacles/mesh_file.hpp"
#include "model/obstacles/obstacle.hpp"

namespace drape::model {

/// What a closed mesh encloses, its coordinates times `scale` giving metres. A mesh that is inside out is turned round. Throws
/// std::invalid_argument as MovingMesh does.
std::unique_ptr<const Shape> mesh_shape(KeyedMesh mesh, double scale);

/// The same of the mesh of a file, at rest. Throws as read_mesh as well.
std::unique_ptr<const Shape> mesh_shape(const std::string& file, double scale);

/// All parts of an obstacle as what their drawn surfaces enclose: the sphere as a polyhedron. Throws std::invalid_argument,
/// which says what its surface should be, if it deforms or is not closed, and as ShapeRule::make() does.
std::vector<Obstacle> mesh_parts_of(const ObstacleRule& rule);

}  // namespace drape::model
