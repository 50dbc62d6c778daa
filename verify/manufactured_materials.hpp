#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "verify/model_fixtures.hpp"

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
inline std::ostream& operator<<(std::ostream& out, const NamedMaterial& named) { return out << named.name; }

/// All forces together: as in the thesis but for its shear, all that have energies, and with the membrane.
inline std::vector<NamedMaterial> joint_materials() {
  return {
      {"all", made_of(tension, little_damping, soft_shear, soft_contraction, soft_plate)},
      {"all_with_energies", made_of(tension, little_projected_damping, soft_shear, soft_contraction, soft_unprojected_plate)},
      {"all_with_a_membrane", made_of(tension, little_damping, soft_shear, soft_contraction, soft_membrane)}};
}

inline std::vector<NamedMaterial> with_joint_materials(std::vector<NamedMaterial> materials) {
  for (const NamedMaterial& joint : joint_materials()) materials.push_back(joint);
  return materials;
}

/// For a few particles, whose motion is well posed whatever their forces.
inline std::vector<NamedMaterial> single_materials() {
  return with_joint_materials({{"tension", made_of(tension)},
                               {"damping", made_of(damping)},
                               {"projected_damping", made_of(projected_damping)},
                               {"shear", made_of(soft_shear)},
                               {"printed_shear", made_of(soft_shear, [](Material& m) { m.shear_form = ShearForm::printed; })},
                               {"contraction", made_of(soft_contraction)},
                               {"membrane", made_of(soft_membrane)},
                               {"plate", made_of(soft_plate)},
                               {"unprojected_plate", made_of(soft_unprojected_plate)}});
}

/// For finer and finer grids. Forces that alone have no well-posed motion in the continuum are carried by tension: projected
/// damping resists stretching only, shear and contraction are indefinite; viscous contraction moreover wants d12² < d1 d2.
inline std::vector<NamedMaterial> carried_materials() {
  return with_joint_materials({{"tension", made_of(tension)},
                               {"damping", made_of(damping)},
                               {"projected_damping", made_of(tension, little_projected_damping)},
                               {"shear", made_of(tension, soft_shear)},
                               {"contraction", made_of(tension, little_projected_damping, soft_contraction)},
                               {"membrane", made_of(soft_membrane)},
                               {"membrane_with_tension", made_of(tension, soft_membrane)},
                               {"plate", made_of(soft_plate)},
                               {"unprojected_plate", made_of(soft_unprojected_plate)}});
}

}  // namespace drape::verify::manufactured
