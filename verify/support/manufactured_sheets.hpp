#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "model/sheet/normals.hpp"
#include "reference/exact/manufactured.hpp"
#include "verify/support/known_motions.hpp"
#include "verify/support/model_fixtures.hpp"

/// Sheets whose motion was chosen beforehand: the compiled model with the load that the continuum says is missing.
namespace drape::verify::manufactured {

using namespace sheets;
using Eigen::Vector3d;
using known_motions::Problem;
using reference::Function;
using reference::Surface;
using reference::SurfacePoint;

constexpr double start_time = 0.3;  ///< [s], not zero, so that nothing can leave it out

// --- Surfaces --------------------------------------------------------------------------------------------------------------

constexpr double size_u = 1.2, size_v = 0.7;  ///< [m]

/// On [0, length]: 1, a line from 0 to 1, and an arch without symmetry that vanishes at both ends with its second derivative,
/// as plates with free or supported borders want it; no other derivative vanishes there.
Function basis(int k, double length);

/// How a sheet moves.
struct Motion {
  bool curved, free, moving;

  std::string name() const {
    return std::string(curved ? "curved" : "planar") + (free ? "_free" : "_fixed") + (moving ? "_moving" : "_steady");
  }
};

std::ostream& operator<<(std::ostream& out, const Motion& motion);

/// Planar and curved, with fixed and free borders, steady and moving.
std::vector<Motion> motions();

/// Stretched everywhere and sheared; if it moves, it drifts and stretches at a constant rate, and swings.
Surface surface(const Motion& motion);

/// The grid of refinement k: spacings and numbers of particles differ along u and v.
Grid grid(int k);

/// The surface at the nodes of a grid.
class Nodes {
 public:
  Nodes(const Grid& grid, const Surface& surface);

  reference::MovingJet jet(int i, double t) const { return points_[i].at(t); }

  State state(double t) const;

 private:
  std::vector<SurfacePoint> points_;
};

// --- The model and its continuum -------------------------------------------------------------------------------------------

reference::ContinuumMaterial continuum(const Material& m);

reference::DualCell dual_cell(const Grid& grid, int a, int b);

/// An error for negative controls: the load of the border at the end of u is missing.
reference::DualCell no_traction_on_the_right(const Grid& grid, int a, int b);

/// What the continuum adds to the forces of a sheet. The edge forces of a projected plate act along the same vertex normals as
/// the bending that they balance: those are one-sided on borders, and with the exact normals what is left is of first order
/// (measured: 1.5 falling to 0.8).
class Load {
 public:
  using CellOf = reference::DualCell (*)(const Grid& grid, int a, int b);

  Load(const Grid& grid, const reference::ContinuumMaterial& material, const Surface& surface, CellOf cell);

  void add(double t, const Vectors& x, Vectors& f);

 private:
  void evaluate(double t);

  Grid grid_;
  reference::ContinuumMaterial material_;
  Nodes nodes_;
  CellOf cell_;
  model::Normals vertex_normals_;
  std::optional<double> time_;
  Vectors force_, bending_, normals_;
};

/// Adds a load to both forms of the force.
void add_load(SplitOde& ode, const SplitOde::Force& add);

/// The compiled model alone, its border pinned to the surface unless it is free.
Problem unloaded(const Grid& grid, const Material& material, const Motion& motion);

/// The compiled model with the load of a continuum, which should be its own: then the surface is its solution except for the
/// error of the discretisation.
Problem loaded(const Grid& grid, const Material& material, const Motion& motion, const reference::ContinuumMaterial& continuum,
               Load::CellOf cell = dual_cell);
Problem loaded(const Grid& grid, const Material& material, const Motion& motion);

/// Square root of the mean square over the sheet, each node with its dual cell: the norm of L2.
double l2_norm(const SplitOde& ode, const Vectors& difference);

}  // namespace drape::verify::manufactured
