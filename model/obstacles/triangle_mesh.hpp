#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <span>
#include <string>
#include <vector>

namespace drape::model {

/// A surface of triangles; if it is closed their corners go round counter-clockwise, seen from outside.
struct TriangleMesh {
  std::string name;  ///< for messages
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Turns a mesh round that is inside out.
void turn_outward(TriangleMesh& mesh);

/// Throws std::invalid_argument with the name of the mesh unless every triangle has an area and the mesh encloses a volume.
void require_volume(const TriangleMesh& mesh);

using Corners = std::array<Eigen::Vector3d, 3>;

Corners corners(const TriangleMesh& mesh, const std::array<int, 3>& triangle);

/// Unit; 0 if the triangle has no area.
Eigen::Vector3d face_normal(const Corners& corners);

/// The means of the corners of triangles [m].
std::vector<Eigen::Vector3d> centres_of(std::span<const Corners> triangles);

/// The boxes around triangles, larger by `margin` on all sides [m].
std::vector<Eigen::AlignedBox3d> boxes_of(std::span<const Corners> triangles, double margin = 0);

/// Parts of a triangle: its face, the edges from corner k to the next, the corners.
inline constexpr int face_part = 0, first_edge_part = 1, first_corner_part = 4;

/// The unit pseudo-normals of a closed mesh [Bærentzen, Aanæs 2005]: p is outside where p minus the nearest point has a
/// positive product with the pseudo-normal of the part on which that point lies.
class PseudoNormals {
 public:
  /// Throws std::invalid_argument with the name of the mesh unless every edge belongs to two triangles that agree on which side
  /// is outside.
  explicit PseudoNormals(const TriangleMesh& mesh);

  /// With the vertices where they are in `mesh`, which has the same triangles.
  Eigen::Vector3d at(const TriangleMesh& mesh, int triangle, int part) const;

 private:
  std::vector<std::array<int, 3>> neighbours_;  ///< triangles across the edges
  std::vector<int> first_;                      ///< place of the first triangle of each vertex, and the end
  std::vector<int> around_;                     ///< triangles of the vertices
};

/// The point of a triangle nearest to another, and the part on which it lies.
struct TrianglePoint {
  Eigen::Vector3d point;
  int part;
};

/// [Ericson 2005, Real-Time Collision Detection, 5.1.5]
TrianglePoint nearest_on_triangle(const Corners& corners, const Eigen::Vector3d& p);

/// Barycentric coordinates of such a point.
Eigen::Vector3d barycentric(const Corners& corners, const TrianglePoint& at);

}  // namespace drape::model
