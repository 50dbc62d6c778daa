#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "model/obstacles/polygons.hpp"
#include "model/obstacles/triangle_mesh.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// A triangle mesh that rides on a grid, whose cells are split into a lower left and an upper right half: its vertices keep
/// their barycentric coordinates in the half in which they lie on the pattern [Etzmuß 2002, 2.7], or beside which, by up to a
/// tenth.
class TrimmedSurface {
 public:
  /// `pattern`: flat, in the plane of the grid's pattern [m]. Throws std::invalid_argument, naming the mesh and the vertex,
  /// unless all vertices lie on the grid.
  TrimmedSurface(const Grid& grid, const TriangleMesh& pattern);

  /// Where it is if the particles are at x.
  Polygons at(const Vectors& x) const;

  /// A vertex: three particles and their weights, whose sum is 1.
  struct Vertex {
    std::array<int, 3> particles;
    Eigen::Vector3d weights;
  };

 private:
  std::vector<Vertex> vertices_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace drape::model
