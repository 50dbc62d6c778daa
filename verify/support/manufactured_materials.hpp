#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "verify/support/model_fixtures.hpp"

/// Materials of sheets that move: every force alone or carried by others, and all together.
namespace drape::verify::manufactured {

using namespace sheets;

// Moduli small enough for explicit steps to follow cheaply.
inline void damping(Material& m) { m.damping = {0.3, 0.2}; }
inline void little_damping(Material& m) { m.damping = {0.05, 0.03}; }
inline void little_projected_damping(Material& m) { little_damping(m), m.damping_form = DampingForm::projected; }
inline void soft_shear(Material& m) { m.shear = 0.8, m.shear_damping = 0.02; }
inline void soft_contraction(Material& m) { m.contraction = 1.1, m.contraction_damping = 0.02; }
inline void soft_membrane(Material& m) {
  m.bend = {0.2, 0.15}, m.bend_damping = {0.01, 0.02}, m.bend_form = BendForm::membrane;
}
inline void soft_plate(Material& m) { m.bend = {0.01, 0.0075}, m.bend_damping = {5e-5, 7e-5}; }
inline void soft_unprojected_plate(Material& m) { soft_plate(m), m.bend_projected = false; }

struct NamedMaterial {
  std::string name;
  Material material;
};
std::ostream& operator<<(std::ostream& out, const NamedMaterial& named);

/// All forces together: as in the thesis except for its shear, all that have energies, and with the membrane.
std::vector<NamedMaterial> joint_materials();

std::vector<NamedMaterial> with_joint_materials(std::vector<NamedMaterial> materials);

/// For a few particles, whose motion is well posed whatever their forces.
std::vector<NamedMaterial> single_materials();

/// For finer and finer grids. Forces that alone have no well-posed motion in the continuum are carried by tension: projected
/// damping resists stretching only, shear and contraction are indefinite; viscous contraction moreover wants d12² < d1 d2.
std::vector<NamedMaterial> carried_materials();

}  // namespace drape::verify::manufactured
