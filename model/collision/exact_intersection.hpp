#pragma once

#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// Whether two triangles have a point in common, by exact predicates: touching counts. One without area has none.
bool intersect(const Corners& one, const Corners& other);

}  // namespace drape::model
