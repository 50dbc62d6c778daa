#pragma once

#include <Eigen/Geometry>
#include <array>
#include <random>
#include <vector>

#include "model/obstacles/triangle_mesh.hpp"
#include "solver/state.hpp"
#include "verify/support/mesh_files.hpp"

namespace drape::verify {

/// A closed ball around the origin: an icosahedron whose triangles are quartered a number of times. 30 · 4^times edges.
model::TriangleMesh ball_mesh(double radius, int times);

/// A sheet of 2 m on each side of n × n particles around the origin, front upward, split as a cloth is.
struct TriangleSheet {
  std::vector<std::array<int, 3>> faces;
  solver::Vectors x;

  explicit TriangleSheet(int n);
};

/// A convex body under or in a coarse sheet whose particles are all outside.
struct SheetOverBody {
  TriangleSheet sheet;
  model::TriangleMesh body;
  Eigen::Vector3d centre;  ///< of the body

  /// Whether a point is inside the body.
  bool inside(const Eigen::Vector3d& point) const;
};

/// A random one: a box or a ball, turned in any direction, and a sheet that hangs down at its border, with waves.
SheetOverBody random_sheet_over_body(std::mt19937& random);

}  // namespace drape::verify
