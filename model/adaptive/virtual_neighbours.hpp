#pragma once

#include <span>
#include <vector>

#include "model/adaptive/edge_mesh.hpp"
#include "model/adaptive/insertion.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {

/// A virtual particle in the place of a node's neighbour [Etzmuß 2002, 5.4, fig. 5.12].
struct VirtualNeighbour {
  VirtualParticle particle;
  double length;  ///< rest length of the part of the spring to it [m]
};

/// A spring that an obstacle divides. Forces on its ends are those of the parts beside them; parts between two virtual
/// particles exert none.
struct DividedSpring {
  int spring;
  VirtualNeighbour of_i, of_j;
};

/// Finds the springs of a sheet that are divided. Springs along no edge of a triangle, and diagonals without a spring, are left
/// out.
class VirtualNeighbours {
 public:
  /// `springs`: between nodes of the sheet.
  VirtualNeighbours(const EdgeMesh& sheet, std::span<const Edge> springs);

  /// `x`: positions of the nodes, N × 3 [m], for which the insertion was found. Costs what is divided.
  std::vector<DividedSpring> find(const Vectors& x, const Insertion& insertion) const;

 private:
  struct Along {
    int spring = -1;       ///< −1: none
    bool forward = false;  ///< i is the first end of the edge
    double length = 0;     ///< at rest [m]
  };
  std::vector<Along> along_;              ///< edges of the mesh
  std::vector<std::array<int, 2>> ends_;  ///< of these edges
};

}  // namespace drape::model
