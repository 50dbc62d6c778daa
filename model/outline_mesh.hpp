#pragma once

#include "model/obstacles/triangle_mesh.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// A flat mesh of what a grid's sides, or its cut, have between them, by constrained Delaunay triangulation [Shewchuk 2002;
/// CGAL]: triangles about as large as the grid's cells. Its border lies on the curves: straight pieces exactly, curved ones
/// with two chords for each cell along them.
TriangleMesh outline_mesh(const Grid& grid);

}  // namespace drape::model
