#pragma once

#include <array>
#include <vector>

#include "model/adaptive/edge_mesh.hpp"
#include "model/adaptive/insertion.hpp"
#include "solver/state.hpp"

namespace drape::model {

/// A sheet with its virtual particles as one mesh, which exists in one step only.
struct RefinedSheet {
  std::vector<VirtualParticle> particles;     ///< those inserted, then those where segments cross; numbered after the nodes
  std::vector<std::array<int, 3>> triangles;  ///< as the faces go round
  std::vector<int> parents;                   ///< faces of the sheet in which the triangles are

  /// Where a node of the sheet, whose nodes are at x, N × 3, or a virtual particle is [m].
  Eigen::Vector3d position(int number, const solver::Vectors& x) const;
};

/// Merges the constrained Delaunay triangulations of all hit faces, in their planes, with the other faces [Etzmuß 2002, 5.3].
/// Predicates are exact [CGAL]. Where images of segments cross, a particle is added on the one farther away from the face.
RefinedSheet refine(const EdgeMesh& sheet, const solver::Vectors& x, const Insertion& insertion);

}  // namespace drape::model
