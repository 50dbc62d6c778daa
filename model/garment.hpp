#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/obstacles/surface.hpp"
#include "model/scene.hpp"

namespace drape::model {

/// In the order of PanelSide.
inline constexpr std::string_view panel_side_names[] = {"lower", "right", "upper", "left"};

/// The panels of a scene and what joins them. Particles are those of the panels, one panel after the other; those that seams
/// join are one node, and nodes are what moves. A scene without panels has one, its sheet, whose particles are the nodes.
class Garment {
 public:
  struct Panel {
    std::string name;  ///< empty: the sheet of a scene without panels
    Sheet sheet;
    Start start;
    int first;               ///< of its particles among all
    std::vector<int> nodes;  ///< of its particles; empty if they are the same

    int node(int particle) const { return nodes.empty() ? particle : nodes[static_cast<std::size_t>(particle)]; }

    /// The values of its particles among those of the nodes: the same object if they are the same, else `own`.
    const Vectors& seen(const Vectors& all, Vectors& own) const;

    /// Adds values of its particles to those of the nodes.
    void add(const Vectors& own, Vectors& all) const;
  };

  /// Throws std::invalid_argument, naming the seam, if one cannot be sewn.
  explicit Garment(const Scene& scene);

  std::span<const Panel> panels() const { return panels_; }

  /// Throws std::invalid_argument, naming all that there are.
  const Panel& panel(const std::string& name) const;

  int particles() const { return particles_; }
  int nodes() const { return nodes_; }
  bool is_one_sheet() const { return panels_.front().nodes.empty(); }

  /// What each node will be once the seams that pull it have met: the same for all nodes that do. Empty if no seams are pulled.
  const std::vector<int>& sewn_nodes() const { return sewn_; }

  /// The mass of each node [kg]. What a cut leaves outside has the mass of the others on average.
  Eigen::VectorXd masses() const;

  /// The same without what a cut leaves outside.
  Eigen::VectorXd cloth_masses() const;

  /// The area of cloth that each node stands for [m²].
  Eigen::VectorXd areas() const;

  /// Positions and velocities at t = 0; those of nodes are means of their particles, by mass.
  solver::State start() const;

  /// All pins of a phase that begins with nodes at x, at most one for a node.
  std::vector<solver::Pin> pins(const Scene& phase, const Vectors& x) const;

  /// The state of the nodes whose particles have this one: means by mass, so that momentum is kept.
  solver::State gathered(const solver::State& of_particles) const;

  /// The nodes that a cut leaves outside.
  std::vector<int> outside() const;

  /// The values of all particles, which are those of their nodes.
  Vectors spread(const Vectors& nodes) const;
  std::vector<int> spread(const std::vector<int>& nodes) const;

 private:
  /// The particles that a seam joins.
  std::vector<std::pair<int, int>> pairs(const SeamRule& seam) const;
  void sew(std::span<const SeamRule> seams);

  /// The velocities of nodes that seams pull together.
  std::map<int, Eigen::Vector3d> pulled(const Scene& phase, const Vectors& x) const;

  std::vector<Panel> panels_;
  int particles_ = 0, nodes_ = 0;
  std::vector<int> sewn_;
};

/// A garment as quadrilaterals, one for each cell, chains as lines. Vertices are the nodes, which are at x.
Polygons garment_polygons(const Garment& garment, const Vectors& x);

/// Garment::nodes of a scene that is not compiled.
int nodes(const Scene& scene);

/// The panel of a scene. Throws std::invalid_argument, naming all that there are.
const PanelRule& find_panel(const Scene& scene, const std::string& name);

/// The particles of a side of a grid that a seam joins, in its order.
std::vector<int> sewn_particles(const Grid& grid, const SeamSide& side);

/// The length of the chords between them on the pattern [m].
double sewn_length(const Grid& grid, const SeamSide& side);

}  // namespace drape::model
