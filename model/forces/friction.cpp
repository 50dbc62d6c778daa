#include "model/forces/remembered_stresses.hpp"

namespace drape::model {

/// Friction between yarns in shear and bending, beside their elastic forces: hysteresis whose width does not depend on the
/// rate.
std::optional<Term> make_friction(const Sheet& sheet) {
  const Friction& friction = sheet.material.friction;
  const auto stresses = std::make_shared<RememberedStresses>();
  const auto law = [&](double limit, double onset) -> std::shared_ptr<const StressLaw> {
    if (limit == 0) return {};
    if (friction.law == FrictionKind::jenkin) return std::make_shared<JenkinLaw>(limit, onset);
    return std::make_shared<DahlLaw>(limit, onset);
  };

  if (const auto shear = law(friction.shear, friction.shear_onset)) add_shear(sheet.grid, shear, *stresses);
  add_bending(sheet.grid, law(friction.bend.weft, friction.bend_onset), law(friction.bend.warp, friction.bend_onset),
              *stresses);
  return remembering_term(stresses);
}

}  // namespace drape::model
