#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/forces/term.hpp"
#include "model/obstacles/contacts.hpp"
#include "model/trimmed_surface.hpp"
#include "solver/split_ode.hpp"

namespace drape::model {

/// A point of the way of pinned particles.
struct PathPoint {
  double t = 0;                                        ///< [s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< from the start [m]
};

/// Prescribes the motion of some particles.
struct PinRule {
  std::string panel = {};                      ///< whose particles they are; empty: of the sheet
  std::string where;                           ///< a name from `pin_places()`, or empty
  std::vector<std::pair<int, int>> particles;  ///< (a, b) along u and v, if `where` is empty
  std::array<bool, 3> directions{true, true, true};
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< instead of `directions` a single one, unless it is 0
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d circle = Eigen::Vector3d::Zero();     ///< x, y and radius on the pattern [m], if nothing else is named
  std::vector<PathPoint> path = {};                     ///< instead of a velocity; times ascend, and between them it is uniform

  /// Whether it has a direction of its own instead of those of axes.
  bool oblique() const { return !direction.isZero(0); }
};

enum class Plane { horizontal, vertical };  ///< u along x; v along y or along z

/// Waves along the weft, out of the plane of the sheet: a curtain. Edge k of a line has the direction
/// θ_k = θ sin(2π count (k + ½)/(n_u − 1)), so that all keep their lengths.
struct Pleats {
  int count = 0;
  double degrees = 0;  ///< θ, the steepest
};

enum class RestShape {
  flat,
  start,  ///< the shape that the sheet begins with, as far as bending knows: pleats stay
};

/// Where and how a sheet begins: flat, pleated or wrapped, stretched, moved to its place, moving as a whole.
struct Start {
  Plane plane = Plane::horizontal;
  WeftWarp stretch{1, 1};
  Pleats pleats;

  /// Depth over half the width of the ellipse on whose half each line along the weft is laid, from −x by −y to x, as long as it
  /// is; 0: they stay straight.
  double wrap = 0;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< axis times angle [degrees], about the origin
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the origin [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
};

/// A triangle mesh that is drawn in the place of the grid [Etzmuß 2002, 2.7]: that of a file, or one of the outline.
struct Trim {
  std::string file = {};  ///< flat, on the pattern; empty: none
  double scale = 1;       ///< metres for a unit of the file
  bool outline = false;   ///< of the grid's sides, or of its cut (outline_mesh.hpp)

  bool given() const { return outline || !file.empty(); }
};

/// A panel of a garment. What its sheet has besides is the same for all.
struct PanelRule {
  std::string name;
  std::string fabric;  ///< as Scene::fabric
  Grid grid;
  Material material;
  Start start;
  Trim trim = {};
};

enum class PanelSide { lower, right, upper, left };

/// A side of a panel, or a part of it, that a seam joins.
struct SeamSide {
  std::string panel;
  PanelSide side = PanelSide::left;
  std::vector<int> ends;  ///< the first and the last particle along the side, as the seam goes; empty: all of them, upwards
};

/// Joins two sides particle by particle.
struct SeamRule {
  SeamSide one, other;
  double ease = 0.02;  ///< part by which one may be longer than the other
};

enum class SeamState {
  sewn,    ///< their particles are one
  pulled,  ///< they are moved uniformly until they meet, at the time to which the phase lasts
  open,    ///< they do nothing
};

/// A time in which things are other than in the rest of a scene.
struct PhaseRule {
  double until = 0;                             ///< [s]
  std::optional<Eigen::Vector3d> gravity = {};  ///< [m/s²]
  SeamState seams = SeamState::sewn;
  std::optional<std::vector<PinRule>> pins = {};
};

/// A scene as users describe it. A value: copy it, change it, compile it.
struct Scene {
  std::string name;
  std::string description;
  std::string fabric;  ///< the measured cloth that the material began with; empty if it has none
  Sheet sheet;         ///< with panels without grid
  std::vector<PanelRule> panels;
  std::vector<SeamRule> seams;
  std::vector<PinRule> pins;
  std::vector<ObstacleRule> obstacles;
  ContactRule contact;
  Start start;
  RestShape rest = RestShape::flat;
  Trim trim;
  std::vector<PhaseRule> phases;  ///< `until` ascends
  double end = 1;                 ///< [s]

  // What phases have besides (model/phases.hpp):
  double begin = 0;  ///< [s]
  SeamState seam_state = SeamState::sewn;
  double seams_meet = 0;  ///< when pulled ones do [s], not before the end
};

/// The names that `PinRule::where` knows.
const std::vector<std::string>& pin_places();

/// The particles that a rule names.
std::vector<int> pinned_particles(const Grid& grid, const PinRule& rule);

/// The grid whose particles a rule names. Throws std::invalid_argument if there is no such panel.
const Grid& pinned_grid(const Scene& scene, const PinRule& rule);

/// The pins of a scene at its start, at most one for a node. Later rules win where directions overlap; of those that are not
/// orthogonal, both hold. What a cut leaves outside is pinned where it is.
std::vector<solver::Pin> pins(const Scene& scene);

/// What finds the contacts of its obstacles. Throws as Contacts does.
Contacts contacts(const Scene& scene, solver::Counters& work);

/// The state at the start without prescribed velocities.
solver::State start(const Scene& scene);

/// The same of one sheet.
solver::State start_of(const Grid& grid, const Start& start);

/// The meshes that are drawn in the place of the grids, if there is one; grids without one are drawn as they are. They ride on
/// the particles of all panels. Throws std::invalid_argument, naming the panel, as read_mesh and TrimmedSurface do.
std::optional<TrimmedSurface> trimmed_surface(const Scene& scene);

/// The scene without what changes no motion.
Scene without_trim(Scene scene);

/// Length by which errors are divided: the longer side, of a curved panel that of the box around its particles, of panels the
/// longest [m].
double size(const Scene& scene);

/// Whether obstacles or the cloth itself stop its motion, which is not smooth then.
bool has_contacts(const Scene& scene);

/// Numerical stiffness ν_h = h² k/(ρ l²), the largest of panels, weft and warp [Etzmuß 2002, 3.4.4].
double numerical_stiffness(const Scene& scene, double h);

/// h k/d, the largest of panels, weft and warp; infinite without damping, 0 without tension.
double stiffness_to_damping(const Scene& scene, double h);

}  // namespace drape::model
