#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "model/sheet/outline.hpp"

namespace drape::model {

/// An edge of a panel of a sewing pattern, between two of its corners.
struct PatternEdge {
  CurvePiece curve;
  int number;  ///< in its file
};

/// A flat piece of cloth, and where it is before it is sewn.
struct PatternPanel {
  std::string name;
  std::vector<PatternEdge> edges;  ///< closed, counterclockwise
  Eigen::Matrix3d rotation;        ///< of the panel that stands upright: u along x, v along z
  Eigen::Vector3d position;        ///< of the origin of its pattern [m]
};

struct EdgeOfPanel {
  std::size_t panel, edge;  ///< places in the lists
};

/// Two edges that are sewn. Which end meets which, a pattern does not say.
using Stitch = std::array<EdgeOfPanel, 2>;

/// Panels of any number of edges and what joins them, as programs that draft patterns have them.
struct SewingPattern {
  std::string file;  ///< for messages
  std::string name;
  std::vector<PatternPanel> panels;
  std::vector<Stitch> stitches;

  const PatternPanel& panel(const EdgeOfPanel& at) const { return panels[at.panel]; }
  const PatternEdge& edge(const EdgeOfPanel& at) const { return panel(at).edges[at.edge]; }

  /// "shirt.json: panel left_sleeve".
  std::string place(std::size_t panel) const;
};

/// A pattern of GarmentCode (JSON with panels and stitches) [Korosteleva, Sorkine-Hornung 2023]. Lengths become metres, and
/// its y, which points up, becomes z. Throws SceneError, naming the panel and the edge, unless every panel is closed and does
/// not cross itself, and stitches join edges that are there.
SewingPattern read_garmentcode(const std::string& file);

}  // namespace drape::model
