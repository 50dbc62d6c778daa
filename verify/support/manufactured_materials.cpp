#include "verify/support/manufactured_materials.hpp"

namespace drape::verify::manufactured {

std::ostream& operator<<(std::ostream& out, const NamedMaterial& named) { return out << named.name; }

std::vector<NamedMaterial> joint_materials() {
  return {
      {"all", made_of(tension, little_damping, soft_shear, soft_contraction, soft_plate)},
      {"all_with_energies", made_of(tension, little_projected_damping, soft_shear, soft_contraction, soft_unprojected_plate)},
      {"all_with_a_membrane", made_of(tension, little_damping, soft_shear, soft_contraction, soft_membrane)}};
}

std::vector<NamedMaterial> with_joint_materials(std::vector<NamedMaterial> materials) {
  for (const NamedMaterial& joint : joint_materials()) materials.push_back(joint);
  return materials;
}

std::vector<NamedMaterial> single_materials() {
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

std::vector<NamedMaterial> carried_materials() {
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
