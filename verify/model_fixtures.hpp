#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <random>
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
inline void linear_damping(Material& m) { m.damping = {0.7, 0.4}; }
inline void projected_damping(Material& m) { linear_damping(m), m.damping_form = DampingForm::projected; }
inline void shear(Material& m) { m.shear = 1.5, m.shear_damping = 0.6; }
inline void printed_shear(Material& m) { shear(m), m.shear_form = ShearForm::printed; }
inline void contraction(Material& m) { m.contraction = 1.1, m.contraction_damping = 0.3; }
inline void membrane(Material& m) { m.bend = {0.9, 0.6}, m.bend_damping = {0.2, 0.3}, m.bend_form = BendForm::membrane; }
inline void plate(Material& m) { m.bend = {0.06, 0.04}, m.bend_damping = {0.01, 0.02}; }
inline void printed_plate(Material& m) { plate(m), m.bend_form = BendForm::printed; }
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
};

inline std::vector<ForceCase> force_cases() {
  const Material energies = made_of(tension, projected_damping, shear, contraction, unprojected_plate);
  const Material thesis = made_of(tension, linear_damping, printed_shear, contraction, plate);
  const Material with_membrane = made_of(tension, linear_damping, shear, contraction, membrane);
  const Eigen::Vector3d g(0.5, -0.3, -2);
  // clang-format off
  //                                                        energy   momentum angular dissipates rotation chains
  return {{"tension",             made_of(tension),           true,    true,    true,    true,     true,    true},
          {"linear_damping",      made_of(linear_damping),    false,   true,    true,    true,     false,   true},
          {"projected_damping",   made_of(projected_damping), false,   true,    true,    true,     true,    true},
          {"shear",               made_of(shear),             true,    true,    true,    true,     true,    false},
          {"printed_shear",       made_of(printed_shear),     false,   false,   false,   false,    true,    false},
          {"contraction",         made_of(contraction),       true,    true,    true,    false,    true,    false},
          {"membrane",            made_of(membrane),          false,   false,   false,   false,    false,   false},
          {"plate",               made_of(plate),             false,   false,   false,   false,    false,   false},
          {"printed_plate",       made_of(printed_plate),     false,   false,   false,   false,    false,   false},
          {"unprojected_plate",   made_of(unprojected_plate), true,    true,    true,    true,     false,   true},
          {"gravity",             Material{},                 true,    false,   false,   true,     true,    true,  g},
          {"all_with_energies",   energies,                   true,    false,   false,   true,     false,   true,  g},
          {"all_of_the_thesis",   thesis,                     false,   false,   false,   false,    false,   false, g},
          {"all_with_a_membrane", with_membrane,              false,   false,   false,   false,    false,   false, g}};
  // clang-format on
}

inline ForceCase force_case(const std::string& name) {
  const auto cases = force_cases();
  return *std::ranges::find(cases, name, &ForceCase::name);
}

/// Grids with spacings that differ. The smallest have borders only; chains run along u and along v.
struct NamedGrid {
  std::string name;
  Grid grid;
};

/// One with an inside, borders and corners.
inline Grid five_by_four() { return {5, 4, 1.0, 0.6}; }

inline std::vector<NamedGrid> grids() {
  return {{"2x2", {2, 2, 0.3, 0.2}}, {"3x2", {3, 2, 0.5, 0.2}},      {"2x4", {2, 4, 0.3, 0.6}},    {"3x3", {3, 3, 0.5, 0.4}},
          {"5x4", five_by_four()},   {"chain_6x1", {6, 1, 1, 0.25}}, {"chain_1x5", {1, 5, 0.2, 1}}};
}

inline bool is_chain(const Grid& grid) { return grid.nu == 1 || grid.nv == 1; }

inline Scene scene_of(const ForceCase& force, const Grid& grid) {
  Scene scene;
  scene.sheet = {grid, force.material, force.gravity};
  return scene;
}

inline SplitOde ode_of(const ForceCase& force, const Grid& grid) { return model::compile(scene_of(force, grid)).ode; }

/// Every force on every grid where it exists.
struct Sheet {
  ForceCase force;
  NamedGrid grid;
};

inline std::ostream& operator<<(std::ostream& out, const Sheet& s) { return out << s.force.name << " on " << s.grid.name; }

template <class Condition>
std::vector<Sheet> sheets_where(const Condition& holds) {
  std::vector<Sheet> found;
  for (const ForceCase& force : force_cases())
    for (const NamedGrid& grid : grids())
      if (const Sheet sheet{force, grid}; (force.exists_on_chains || !is_chain(grid.grid)) && holds(sheet))
        found.push_back(sheet);
  return found;
}

/// Name of a value-parameterised test.
inline std::string name_of(const testing::TestParamInfo<Sheet>& test) {
  return test.param.force.name + "_on_" + test.param.grid.name;
}

/// The smaller spacing, the length by which displacements are measured.
inline double spacing(const Grid& grid) { return std::min(grid.spacing_u(), grid.spacing_v()); }

/// n vectors whose components lie in [-amplitude, amplitude].
inline Vectors random_vectors(int n, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> component(-amplitude, amplitude);
  return Vectors::NullaryExpr(n, 3, [&] { return component(generator); });
}

/// Every particle moved by up to a quarter of the spacing in each direction, so that no edge is shorter than half of it; in
/// a second every particle moves as far again.
inline State deformed(const Grid& grid, unsigned seed) {
  const double amplitude = spacing(grid) / 4;
  return {grid.parameters() + random_vectors(grid.particles(), amplitude, seed),
          random_vectors(grid.particles(), amplitude, seed + 1000)};
}

/// The force; what the memory held before must not matter.
inline Vectors evaluate(const SplitOde::Force& force, const State& y) {
  Vectors f = Vectors::Constant(y.x.rows(), 3, 1e9);
  force(0, y.x, y.v, f);
  return f;
}

inline Vectors at_rest(const Vectors& x) { return Vectors::Zero(x.rows(), 3); }

/// Greatest component, the measure of errors relative to it. NaN if there is one, which then fails every comparison.
inline double largest(const Eigen::MatrixXd& a) { return a.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(); }

}  // namespace drape::verify::sheets
