#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/garment.hpp"

namespace drape::model {

/// The triangles of a cloth, between its nodes. Each edge and each vertex belongs to one of them, so that each pair of a vertex
/// and a face, or of two edges, is met once if pairs of faces are.
class ClothSurface {
 public:
  /// A triangle, or an edge of a chain: then the last corner is the second one again.
  struct Face {
    std::array<int, 3> corners;
    std::array<int, 3> vertices, edges;  ///< those that belong to it, then −1; edges as indices
    bool is_edge() const { return corners[1] == corners[2]; }
  };

  /// An edge, from the lower node to the higher.
  struct Edge {
    std::array<int, 2> ends;
    bool has_face;  ///< that is a triangle
  };

  /// All cells of all panels, split as those of TrimmedSurface are. What seams make of a half whose corners they join is an
  /// edge.
  explicit ClothSurface(const Garment& garment);

  /// `corners`: those of faces, as Face has them; `places`: N × 3, where the nodes are once, so that what is near can be told
  /// from what is far [m].
  ClothSurface(std::span<const std::array<int, 3>> corners, Vectors places);

  std::span<const Face> faces() const { return faces_; }
  std::span<const Edge> edges() const { return edges_; }

  /// The corners of the faces that are triangles, front upward where the pattern is.
  std::vector<std::array<int, 3>> triangles() const;

  /// The middles of the faces where the nodes are once.
  std::vector<Eigen::Vector3d> centres() const;

  /// The corners of a face whose nodes are at x, N × 3 [m].
  Corners corners(int face, const Vectors& x) const;

  /// Whether two nodes are the same, or will be once the seams have met that pull them: these bring them together.
  bool joined_nodes(int i, int j) const { return i == j || (!sewn_.empty() && sewn_[i] == sewn_[j]); }

  /// Whether two faces have joined nodes.
  bool joined(int one, int other) const;

 private:
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  Vectors places_;
  std::vector<int> sewn_;  ///< Garment::sewn_nodes()
};

}  // namespace drape::model
