#pragma once

#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// Whether two triangles are nearer than `distance` [m], or an edge of one passes through the other.
bool nearer(const Corners& one, const Corners& other, double distance);

}  // namespace drape::model
