#include <algorithm>

#include "model/forces/linear_operator.hpp"
#include "model/forces/term.hpp"

namespace drape::model {
namespace {

/// The matrix of A (B1 s_uu + B2 s_vv). A border particle takes the curvature of its inner neighbour: zero curvature there
/// would make it first order.
SparseMatrix membrane_matrix(const Grid& grid, const WeftWarp& B) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int i, int before, int centre, int after, double weight) {
    if (weight == 0) return;
    entries.emplace_back(i, before, weight);
    entries.emplace_back(i, centre, -2 * weight);
    entries.emplace_back(i, after, weight);
  };
  const double lu = grid.spacing_u(), lv = grid.spacing_v();
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const int i = grid.index(a, b);
      const double area = grid.cell_area(a, b);
      if (grid.nu > 2) {
        const int c = std::clamp(a, 1, grid.nu - 2);
        add(i, grid.index(c - 1, b), grid.index(c, b), grid.index(c + 1, b), area * B.weft / (lu * lu));
      }
      if (grid.nv > 2) {
        const int c = std::clamp(b, 1, grid.nv - 2);
        add(i, grid.index(a, c - 1), grid.index(a, c), grid.index(a, c + 1), area * B.warp / (lv * lv));
      }
    }
  SparseMatrix matrix(grid.particles(), grid.particles());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

/// Membrane bending f = <N, B1 s_uu + B2 s_vv> N [Etzmuß 2002, (2.24)–(2.25), Alg. 3] with its viscous part (2.30).
std::optional<Term> make_membrane(const Sheet& sheet) {
  const Material& m = sheet.material;
  if ((!m.bend.any() && !m.bend_damping.any()) || m.bend_form != BendForm::membrane) return {};
  return projected(sheet.grid, {membrane_matrix(sheet.grid, m.bend), membrane_matrix(sheet.grid, m.bend_damping)}, sheet.rest);
}

}  // namespace drape::model
