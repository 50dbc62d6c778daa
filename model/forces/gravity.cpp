#include "model/term.hpp"

namespace drape::model {

/// Weight m g. It never changes and is computed once, when the scene is compiled.
std::optional<Term> make_gravity(const Sheet& sheet) {
  if (sheet.gravity.isZero(0)) return {};
  const Grid& grid = sheet.grid;
  Term term;
  term.constant.resize(grid.particles(), 3);
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a)
      term.constant.row(grid.index(a, b)) = sheet.material.density * grid.cell_area(a, b) * sheet.gravity.transpose();
  term.energy = [weight = term.constant](const Vectors& x) { return -weight.cwiseProduct(x).sum(); };
  return term;
}

}  // namespace drape::model
