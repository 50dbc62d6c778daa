#include "model/forces/term.hpp"

namespace drape::model {

/// Weight m g.
std::optional<Term> make_gravity(const Sheet& sheet) {
  if (sheet.gravity.isZero(0)) return {};
  Term term;
  term.law.load = sheet.material.density * sheet.gravity;
  term.energy = [weight = Vectors(sheet.grid.cell_areas() * term.law.load.transpose())](const Vectors& x) {
    return -weight.cwiseProduct(x).sum();
  };
  return term;
}

}  // namespace drape::model
