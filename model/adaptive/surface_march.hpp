#pragma once

#include <cstdint>
#include <iterator>
#include <memory_resource>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "model/adaptive/insertion_draft.hpp"

namespace drape::model {

/// Goes over the surface of an obstacle, prism by prism of a sheet, and inserts the edges that it passes into the faces.
///
/// A triangle of the obstacle is upper in a prism if points that move away from the face leave the obstacle through it. Edges
/// of upper triangles are inserted unless they are flat. From lower triangles, which overhang, the way goes up over convex
/// edges only, and none goes down to the far side.
class SurfaceMarch {
 public:
  /// `vertices` and unit `normals` of the triangles: of the obstacle, at the same time as the prisms [m]; `memory`: for what is
  /// needed until this object ends; `steps`: counts triangles that are clipped by a prism.
  SurfaceMarch(FacePrisms& prisms, const EdgeMesh& obstacle, std::span<const Eigen::Vector3d> vertices,
               std::span<const Eigen::Vector3d> normals, std::pmr::memory_resource& memory, std::int64_t& steps);

  /// Whether there is something to find from a triangle of the obstacle that has a point in common with a face: it has not been
  /// visited there, is in front of the face, and comes from behind it. One that only touches the front is on the far side.
  bool can_enter(int face, int triangle);

  /// Goes on from such a triangle.
  void enter(int face, int triangle);

  Insertion insertion() const { return draft_.finish(); }

 private:
  std::int64_t place(int face, int triangle) const { return face * std::ssize(obstacle_.triangles()) + triangle; }
  void visit(int face, int triangle);
  void pass(int face, int triangle, int side, const Eigen::Vector4d& from, const Eigen::Vector4d& to);
  void insert(int face, int edge, const FacePrism::Part& part);
  bool is_seen_beyond(int face, int edge, const VirtualParticle& particle);
  void go_to(int face, int triangle);

  bool is_upper(int triangle, const Eigen::Vector3d& away) const;
  int neighbour(int face, int side) const;

  FacePrisms& prisms_;
  const EdgeMesh& obstacle_;
  std::span<const Eigen::Vector3d> vertices_;
  std::int64_t& steps_;
  std::span<const Eigen::Vector3d> normals_;
  InsertionDraft draft_;
  std::pmr::unordered_set<std::int64_t> known_,
      inserted_;                                 ///< numbers of pairs: of a face and a triangle, of a face and an edge
  std::pmr::vector<std::pair<int, int>> ahead_;  ///< faces and triangles
};

}  // namespace drape::model
