#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/sheet/outline.hpp"

namespace drape::model {

/// An edge of a panel of a sewing pattern, between two of its corners.
struct PatternEdge {
  CurvePiece curve;
  std::string name;  ///< in its file: "side"; "3" where it has numbers
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

/// Two edges that are sewn.
struct Stitch {
  EdgeOfPanel one, other;

  /// Whether the ends meet with which both begin, counterclockwise; empty: the pattern does not say which do.
  std::optional<bool> side_by_side = {};
};

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

/// Whether a file's name ends as those of patterns and meshes do. One that ends in .toml may be a scene.
bool is_pattern(const std::string& file);

/// A pattern in the format that the end of the file's name tells. Lengths become metres. Throws SceneError, naming the panel
/// and the edge, unless it can be sewn.
SewingPattern read_pattern(const std::string& file);

}  // namespace drape::model
