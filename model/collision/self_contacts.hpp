#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "model/collision/approach.hpp"
#include "model/collision/box_tree.hpp"
#include "model/collision/cloth_surface.hpp"
#include "solver/base/threads.hpp"
#include "solver/counters.hpp"

namespace drape::model {

/// Finds where a cloth comes near itself: pairs of a vertex and a face, or of two edges, that have no joined nodes. Two edges
/// count where they are nearest inside both; where one ends, a vertex and a face are as near, unless it is that of a chain.
/// Pairs come in an order that depends on the surface alone. Memory is kept from call to call.
class SelfContacts {
 public:
  SelfContacts(ClothSurface surface, solver::Counters& work);

  const ClothSurface& surface() const { return surface_; }

  /// Sets `found` to the approaches to `distance` [m] while nodes move uniformly from x0 to x1, N × 3.
  void find(const Vectors& x0, const Vectors& x1, double distance, std::vector<Approach>& found);

  /// Sets `found` to the pairs nearer than `distance` [m] at x, N × 3.
  void near(const Vectors& x, double distance, std::vector<Proximity>& found);

  /// Pairs of triangles without joined nodes that have a point in common at x, as intersect() has it; indices of faces, the
  /// lower first.
  std::vector<std::array<int, 2>> intersections(const Vectors& x);

  /// Number of pairs of triangles without joined nodes that are nearer than `distance` [m] at x.
  int face_pairs(const Vectors& x, double distance);

 private:
  /// Fits the tree to the ways of the faces from x on, and half of `reach` around them [m].
  void fit(const Vectors& x, double reach);

  /// Calls visit(kind, particles, may_end) for pairs between the halves of nodes [begin, end) of the tree that may come within
  /// `reach` on their ways from x; `may_end`: one edge is that of a chain.
  template <class Visit>
  void each_pair(std::int64_t begin, std::int64_t end, const Vectors& x, double reach, const Visit& visit) const;

  /// Sets `found` to what compute(kind, particles, may_end) has found for these pairs of the whole tree, and counts them.
  template <class Found, class Compute>
  void find_pairs(const Vectors& x, double reach, base::Collector<Found>& collect, std::vector<Found>& found,
                  const Compute& compute);

  /// Calls visit(i, j, corners, corners) for pairs of triangles i < j without joined nodes that may be within `reach` at x.
  template <class Visit>
  void each_face_pair(const Vectors& x, double reach, const Visit& visit);

  ClothSurface surface_;
  BoxTree tree_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< of the faces
  Vectors way_;                             ///< of the nodes in a step, without that of all on average [m]
  base::Collector<Approach> collect_approaches_;
  base::Collector<Proximity> collect_proximities_;
  std::int64_t& pairs_;
};

}  // namespace drape::model
