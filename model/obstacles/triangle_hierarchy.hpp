#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/obstacles/triangle_mesh.hpp"

namespace drape::model {

/// Boxes around the triangles of a mesh, in a binary tree, to find the nearest one and the first one on a way. The tree is
/// built once: when vertices move, its boxes are fitted to them.
class TriangleHierarchy {
 public:
  explicit TriangleHierarchy(const TriangleMesh& mesh);

  /// Fits the boxes to the vertices of a mesh with the same triangles. Allocates nothing.
  void refit(const TriangleMesh& mesh);

  struct Found {
    int triangle;
    TrianglePoint nearest;
  };

  /// Allocates nothing.
  Found nearest(const Eigen::Vector3d& p) const;

  /// The part of the straight way between two points after which it is no farther than `distance` > 0 [m] from a triangle, for
  /// the first time; nothing if it stays away. Adds the boxes that were looked into. Allocates nothing.
  std::optional<double> first_within(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double distance,
                                     std::int64_t& boxes) const;

 private:
  /// Its left child follows it.
  struct Node {
    Eigen::AlignedBox3d box;
    int begin, end;  ///< its triangles, as places in `order_`
    int right = 0;   ///< child; 0: it is a leaf
  };

  int build(int begin, int end, const std::vector<Eigen::Vector3d>& centres);

  std::vector<Node> nodes_;
  std::vector<int> order_;        ///< triangles
  std::vector<Corners> corners_;  ///< in this order
};

}  // namespace drape::model
