#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace drape::model {

/// Triangles with the edges between them. The triangles on both sides of an edge go round in the same direction.
class EdgeMesh {
 public:
  struct Edge {
    std::array<int, 2> ends;       ///< as the first triangle goes round; the second one goes back
    std::array<int, 2> triangles;  ///< −1: the edge is on the border
  };

  /// Throws std::invalid_argument, in one line that begins with the name, unless each edge belongs to one or two triangles and
  /// these agree on which side is the front.
  EdgeMesh(const std::string& name, std::span<const std::array<int, 3>> triangles);

  std::span<const std::array<int, 3>> triangles() const { return triangles_; }
  std::span<const Edge> edges() const { return edges_; }

  /// The edges of a triangle, from corner k to the next.
  const std::array<int, 3>& sides(int triangle) const { return sides_[triangle]; }

  /// The triangle on the other side of an edge, −1 on the border.
  int across(int edge, int triangle) const {
    const auto& [one, other] = edges_[edge].triangles;
    return triangle == one ? other : one;
  }

 private:
  std::vector<std::array<int, 3>> triangles_, sides_;
  std::vector<Edge> edges_;
};

}  // namespace drape::model
