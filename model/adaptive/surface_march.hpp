#pragma once

#include <cstdint>
#include <set>
#include <span>
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
  /// `vertices`: of the obstacle, at the same time as the prisms [m]; `steps`: counts triangles that are clipped by a prism.
  SurfaceMarch(FacePrisms& prisms, const EdgeMesh& obstacle, std::span<const Eigen::Vector3d> vertices, std::int64_t& steps)
      : prisms_(prisms), obstacle_(obstacle), vertices_(vertices), steps_(steps), draft_(prisms) {}

  /// Goes on from a triangle of the obstacle that has a point in common with a face, if the obstacle is on both sides of the
  /// face there: one that only touches the front is on the far side.
  void enter(int face, int triangle);

  Insertion insertion() const { return draft_.finish(); }

 private:
  using Place = std::pair<int, int>;  // a face of the sheet and a triangle of the obstacle

  bool comes_from_behind(int face, int triangle);
  void visit(int face, int triangle);
  void pass(int face, int triangle, int edge);
  void insert(int face, int edge, const FacePrism::Part& part);
  bool is_seen_beyond(int face, int edge, const VirtualParticle& particle);
  void go_to(int face, int triangle);

  Corners corners(int triangle) const;
  bool is_upper(int face, int triangle, const Eigen::Vector3d& at);

  FacePrisms& prisms_;
  const EdgeMesh& obstacle_;
  std::span<const Eigen::Vector3d> vertices_;
  std::int64_t& steps_;
  InsertionDraft draft_;
  std::set<Place> known_;
  std::set<std::pair<int, int>> inserted_;  ///< faces of the sheet with edges of the obstacle
  std::vector<Place> ahead_;
};

}  // namespace drape::model
