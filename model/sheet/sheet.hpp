#pragma once

#include <string>
#include <vector>

#include "model/memory/curve.hpp"
#include "model/memory/spectrum.hpp"
#include "model/sheet/grid.hpp"

namespace drape::model {

/// A modulus with a value in the weft (u) and one in the warp (v) direction.
struct WeftWarp {
  double weft = 0;
  double warp = 0;

  bool any() const { return weft != 0 || warp != 0; }

  WeftWarp& operator+=(const WeftWarp& other) {
    weft += other.weft, warp += other.warp;
    return *this;
  }
  bool operator==(const WeftWarp&) const = default;
};

enum class DampingForm {
  linear,     ///< d/l² (v_j − v_i), also transversally: the form that the integrators of chapter 3 treat implicitly
  projected,  ///< d/l² <v_j − v_i, (x_j − x_i)°> (x_j − x_i)°, the viscous stress of the model
};

enum class ShearForm {
  conservative,   ///< W = ½ G γ², γ = <s_u, s_v> less than at rest, consistent at borders
  printed,        ///< Algorithm 2 of the thesis: wide stencil, unit vectors; not the gradient of an energy
  diagonals,      ///< both diagonals of a cell; this and the next: models of the survey, forces/survey_shear.cpp
  triangles,      ///< one of them
  hinges,         ///< angles between edges
  baraff_witkin,  ///< angles of triangles
};

enum class BendForm {
  membrane,           ///< second order [Etzmuß 2002, (2.24)]; always projected onto the normal
  plate,              ///< fourth order [Etzmuß 2002, (2.26)]
  printed,            ///< the plate of Algorithm 4: not consistent on borders and without twist; always projected
  printed_is_border,  ///< the same without forces across borders on border particles [Etzmuß 2002, 6.2.1]
};

enum class CurveForm {
  affine,  ///< straight pieces between the points of a curve
  smooth,  ///< cubic ones with continuous slopes
};

enum class FrictionKind {
  dahl,    ///< approaches its limit exponentially
  jenkin,  ///< elastic up to its limit: Coulomb's law beside a spring
};

/// Friction between yarns. Limits 0: there is none.
struct Friction {
  FrictionKind law = FrictionKind::dahl;
  double shear = 0;           ///< largest stress [N/m]: half the width of the hysteresis, 2HG
  double shear_onset = 0.01;  ///< shear in which it develops [1]
  WeftWarp bend;              ///< largest moment by width [N]: HB, half of 2HB
  double bend_onset = 5;      ///< curvature in which it develops [1/m]
};

/// What was measured of a fabric   [Wang, O'Brien, Ramamoorthi 2011].
struct FabricTables {
  /// C11, C12, C22, C33 [N/m] of the energy ½ (C11 ε11² + 2 C12 ε11 ε22 + C22 ε22² + C33 ε12²) of Green's strain, which is to
  /// be doubled: at rest, and stretched by a sixth in directions of 0, 22.5, 45, 67.5 and 90 degrees from the weft.
  std::array<std::array<double, 4>, 6> stretching = {};

  /// Bending stiffness [N m] along 0, 45 and 90 degrees from the weft, for curvatures of 0, 10, 20, 30 and 40/m.
  std::array<std::array<double, 5>, 3> bending = {};

  bool operator==(const FabricTables&) const = default;
};

enum class StretchLaw {
  linear,  ///< by the moduli
  tables,  ///< by those of a fabric, whose moduli change with the strain and its direction
};

/// How tension and shear relax, in one of three forms.
struct Relaxation {
  Spectrum maxwell;                        ///< Maxwell elements
  std::vector<KelvinVoigtElement> series;  ///< Kelvin-Voigt elements in series with the modulus [Etzmuß 2002, (2.34)]
  double quality = 0;                      ///< Q, the same throughout `band`; 0: not given
  Band band = {1, 1000};                   ///< [rad/s]

  /// The Maxwell elements of any of them; empty if nothing relaxes, or if the quality is too low for the band.
  Spectrum spectrum() const;
};

/// Elastic moduli and their viscous counterparts (Kelvin–Voigt). Zero: the force does not exist.
struct Material {
  double density = 1;                            ///< ρ [kg/m²]
  WeftWarp tension;                              ///< k1, k2 [N/m]; the first slopes of curves
  StressCurve weft_curve, warp_curve;            ///< in the place of k1, k2
  StressCurve shear_curve;                       ///< [N/m] over <s_u, s_v>, in the place of G
  StressCurve weft_bend_curve, warp_bend_curve;  ///< [N] over curvatures [1/m], in the place of B1, B2
  CurveForm curve_form = CurveForm::affine;
  Friction friction;
  StretchLaw law = StretchLaw::linear;
  FabricTables tables;  ///< zero: not given
  WeftWarp damping;     ///< d1, d2 [N s/m]
  DampingForm damping_form = DampingForm::linear;
  double shear = 0;          ///< G [N/m]
  double shear_damping = 0;  ///< dG [N s/m]
  ShearForm shear_form = ShearForm::conservative;
  Relaxation relaxation;
  double contraction = 0;          ///< C12 [N/m]
  double contraction_damping = 0;  ///< d12 [N s/m]
  WeftWarp bend;                   ///< B1, B2: [N/m] for the membrane, [N m] for the plate
  WeftWarp bend_damping;           ///< dB1, dB2: [N s/m] or [N m s]
  BendForm bend_form = BendForm::plate;
  bool bend_projected = true;  ///< plate only: forces along the vertex normal (as in the thesis), not in all directions
};

/// Whether tables are in the place of k1, k2, C12 and G.
inline bool by_tables(const Material& material) { return material.law == StretchLaw::tables; }

/// Wind from one direction, steady or oscillating [Etzmuß 2002, (2.35)–(2.36)]: (a + sin ωt) w; a surface takes the
/// part along its normal times c_drag and the rest times c_lift.
struct Wind {
  Eigen::Vector3d load = Eigen::Vector3d::Zero();  ///< w, a force per area [N/m²]
  double constant = 1;                             ///< a
  double frequency = 0;                            ///< ω [rad/s]
  double drag = 1;                                 ///< c_drag
  double lift = 0;                                 ///< c_lift

  bool blows() const { return !load.isZero(0) && (constant != 0 || frequency != 0) && (drag != 0 || lift != 0); }
  bool needs_normals() const { return blows() && drag != lift; }  ///< else the surface takes it undivided
};

/// A force that was added to the model's own (model/scene_file/added_forces.hpp), as a scene has it.
struct AddedForce {
  std::string name;
  std::vector<double> parameters;  ///< in the order of its row
  std::string code;                ///< hash of what computes it
};

/// A sheet before it is compiled, from which every force is made.
struct Sheet {
  Grid grid;
  Material material;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s²]
  Wind wind = {};
  double air = 0;             ///< c = c_w ρ_air of the air's resistance (2.37) [N s/m³]
  solver::Vectors rest = {};  ///< positions that it would rest in without gravity, as far as bending knows; empty: flat
  std::vector<AddedForce> added = {};
};

}  // namespace drape::model
