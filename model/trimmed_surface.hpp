#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "model/obstacles/polygons.hpp"
#include "model/obstacles/triangle_mesh.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// Meshes that ride on grids, whose cells are split into a lower left and an upper right half: their vertices keep their
/// barycentric coordinates in the half in which they lie on the pattern [Etzmuß 2002, 2.7], or beside which.
class TrimmedSurface {
 public:
  /// None.
  TrimmedSurface() = default;

  /// The grid as it is.
  explicit TrimmedSurface(const Grid& grid);

  /// `pattern`: flat, in the plane of the grid's pattern [m]. `reach`: how far a vertex may lie beside the half nearest to it,
  /// in barycentric coordinates. Throws std::invalid_argument, naming the mesh and the vertex, unless all vertices lie on the
  /// grid.
  TrimmedSurface(const Grid& grid, const TriangleMesh& pattern, double reach = 0.1);

  /// Adds those of another panel. `first`: of its particles among all.
  void add(const TrimmedSurface& other, int first);

  /// Where they are if the particles are at x.
  Polygons at(const Vectors& x) const;

  /// A vertex: three particles and their weights, whose sum is 1.
  struct Vertex {
    std::array<int, 3> particles;
    Eigen::Vector3d weights;
  };

  const std::vector<Vertex>& vertices() const { return vertices_; }

 private:
  std::vector<Vertex> vertices_;
  std::vector<std::vector<int>> faces_;
};

}  // namespace drape::model
