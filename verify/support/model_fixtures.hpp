#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "model/cloth.hpp"

/// Sheets for the tests of forces: every force alone and several together, on grids that have all kinds of borders.
namespace drape::verify::sheets {

using model::BendForm;
using model::DampingForm;
using model::Grid;
using model::Material;
using model::Scene;
using model::ShearForm;
using solver::SparseMatrix;
using solver::SplitOde;
using solver::State;
using solver::Vectors;

/// The parts of which materials are made. Weft and warp always differ, and the moduli give all forces about the same size on
/// the grids below, so that none hides another.
inline void tension(Material& m) { m.tension = {3, 2}; }
inline void curves(Material& m) {
  m.weft_curve = {model::Polyline({{0, 0}, {0.05, 0.2}, {0.4, 2.5}}), model::Polyline({{0.1, 0}, {0.8, 0.4}, {1, 1}})};
  m.warp_curve = {model::Polyline({{0, 0}, {0.1, 0.2}, {0.3, 0.5}}), {}};
  m.tension = {m.weft_curve.loading.slope(0), m.warp_curve.loading.slope(0)};
}
inline void bent_curves(Material& m) {
  m.shear_curve = {model::Polyline({{0, 0}, {0.1, 0.15}, {0.5, 2}}), model::Polyline({{0.2, 0}, {0.7, 0.4}, {1, 1}})};
  m.weft_bend_curve = {model::Polyline({{0, 0}, {1, 0.06}, {9, 0.2}}), {}};
  m.warp_bend_curve = {model::Polyline({{0, 0}, {2, 0.08}, {9, 0.9}}), model::Polyline({{0, 0}, {0.5, 0.2}, {1, 1}})};
  m.curve_form = model::CurveForm::smooth;
  m.shear = m.shear_curve.loading.slope(0);
  m.bend = {m.weft_bend_curve.loading.slope(0), m.warp_bend_curve.loading.slope(0)};
  m.bend_projected = false;
}
inline void dahl(Material& m) { m.friction = {.shear = 0.3, .shear_onset = 0.2, .bend = {0.1, 0.2}, .bend_onset = 3}; }
inline void jenkin(Material& m) { dahl(m), m.friction.law = model::FrictionKind::jenkin; }
inline void tables(Material& m) {
  m.tables.stretching = {{{2, 0.4, 1.5, 1.2},
                          {2.5, 0.6, 1.4, 1.5},
                          {2.2, 0.5, 1.8, 1.1},
                          {2.9, -3, 1.7, 1.4},
                          {2.4, 0.3, 2, 1.6},
                          {3, 0.7, 1.9, 1.3}}};
  m.tables.bending = {{{0.06, 0.05, 0.04, 0.03, 0.02}, {}, {0.04, 0.05, 0.06, 0.07, 0.08}}};
  m.law = model::StretchLaw::tables;
  m.tension = {4, 3};
  m.bend = {0.06, 0.04};
  m.bend_projected = false;
}
inline void linear_damping(Material& m) { m.damping = {0.7, 0.4}; }
inline void projected_damping(Material& m) { linear_damping(m), m.damping_form = DampingForm::projected; }
inline void shear(Material& m) { m.shear = 1.5, m.shear_damping = 0.6; }
inline void printed_shear(Material& m) { shear(m), m.shear_form = ShearForm::printed; }
inline void diagonals(Material& m) { m.shear = 1.5, m.shear_form = ShearForm::diagonals; }
inline void triangles(Material& m) { m.shear = 1.5, m.shear_form = ShearForm::triangles; }
inline void hinges(Material& m) { m.shear = 1.5, m.shear_form = ShearForm::hinges; }
inline void baraff_witkin(Material& m) { m.shear = 1.5, m.shear_form = ShearForm::baraff_witkin; }
inline void contraction(Material& m) { m.contraction = 1.1, m.contraction_damping = 0.3; }
inline void membrane(Material& m) { m.bend = {0.9, 0.6}, m.bend_damping = {0.2, 0.3}, m.bend_form = BendForm::membrane; }
inline void plate(Material& m) { m.bend = {0.06, 0.04}, m.bend_damping = {0.01, 0.02}; }
inline void printed_plate(Material& m) { plate(m), m.bend_form = BendForm::printed; }
inline void printed_is_border(Material& m) { plate(m), m.bend_form = BendForm::printed_is_border; }
inline void unprojected_plate(Material& m) { plate(m), m.bend_projected = false; }

template <class... Parts>
Material made_of(const Parts&... parts) {
  Material m;
  (parts(m), ...);
  return m;
}

/// A material with what is true of its forces on any sheet that is not degenerate, in any state.
struct ForceCase {
  std::string name;
  Material material;
  bool has_energy;        ///< there is an elastic part, and it is the gradient of an energy
  bool keeps_momentum;    ///< the forces on all particles sum to zero
  bool keeps_angular;     ///< so do the torques of the elastic part
  bool dissipates;        ///< the viscous part cannot gain energy
  bool ignores_rotation;  ///< a rigid rotation meets no viscous force
  bool exists_on_chains;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  model::Wind wind = {};
  double air = 0;  ///< its resistance is the only force that is not linear in v, and that knows who moves
};

std::vector<ForceCase> force_cases();

ForceCase force_case(const std::string& name);

/// Grids with spacings that differ. The smallest have borders only; chains run along u and along v; three are not uniform.
struct NamedGrid {
  std::string name;
  Grid grid;
};

/// One with an inside, borders and corners; a rectangle whose spacings grow; a panel with curved sides and no right angle; a
/// rectangle of which a curve cuts cells and takes the corner off, one particle of which is left outside.
Grid five_by_four();
Grid graded();
Grid curved();
Grid cut();

std::vector<NamedGrid> grids();

/// Whether a force is defined on a grid.
bool exists_on(const Grid& grid, const ForceCase& force);

inline bool is_chain(const Grid& grid) { return grid.nu == 1 || grid.nv == 1; }

Scene scene_of(const ForceCase& force, const Grid& grid);

SplitOde ode_of(const ForceCase& force, const Grid& grid);

/// Every force on every grid where it exists.
struct Sheet {
  ForceCase force;
  NamedGrid grid;
};

std::ostream& operator<<(std::ostream& out, const Sheet& s);

std::vector<Sheet> sheets_where(const std::function<bool(const Sheet&)>& holds);

/// Name of a value-parameterised test.
std::string name_of(const testing::TestParamInfo<Sheet>& test);

/// A sheet that is bent along the weft to a cylinder of this curvature [1/m], with its edges for chords.
Vectors cylinder(const Grid& grid, double kappa);

/// The smallest spacing, the length by which displacements are measured.
double spacing(const Grid& grid);

/// n vectors whose components lie in [-amplitude, amplitude].
Vectors random_vectors(int n, double amplitude, unsigned seed);

/// Every particle moved by up to a quarter of the spacing in each direction, so that no edge is shorter than half of it; in
/// a second every particle moves as far again, while the whole rises by a spacing: faster than any falls, so that none comes
/// near the kinks of the air's resistance.
State deformed(const Grid& grid, unsigned seed);

/// The force; what the memory held before must not matter.
Vectors evaluate(const SplitOde::Force& force, const State& y);

Vectors at_rest(const Vectors& x);

/// Greatest component, the measure of errors relative to it. NaN if there is one, which then fails every comparison.
double largest(const Eigen::MatrixXd& a);

}  // namespace drape::verify::sheets
