#include "model/forces/linear_operator.hpp"
#include "model/forces/term.hpp"

namespace drape::model {
namespace {

/// The matrix of the force −∇E for E = ½ Σ A (B1 |D²_u x|² + B2 |D²_v x|²) + ½ Σ_cells l_u l_v (B1 + B2) |D_u D_v x|².
SparseMatrix plate_matrix(const Grid& grid, const WeftWarp& B) {
  const double lu = grid.spacing_u(), lv = grid.spacing_v();
  const auto index = [&](int a, int b) { return grid.index(a, b); };
  std::vector<Eigen::Triplet<double>> entries;
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const double area = grid.cell_area(a, b);
      if (a > 0 && a < grid.nu - 1)
        add_quadratic(entries, {{index(a - 1, b), 1}, {index(a, b), -2}, {index(a + 1, b), 1}},
                      area * B.weft / (lu * lu * lu * lu));
      if (b > 0 && b < grid.nv - 1)
        add_quadratic(entries, {{index(a, b - 1), 1}, {index(a, b), -2}, {index(a, b + 1), 1}},
                      area * B.warp / (lv * lv * lv * lv));
      if (a > 0 && b > 0)
        add_quadratic(entries, {{index(a, b), 1}, {index(a - 1, b), -1}, {index(a, b - 1), -1}, {index(a - 1, b - 1), 1}},
                      (B.weft + B.warp) / (lu * lv));
    }
  SparseMatrix matrix(grid.particles(), grid.particles());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

/// Thin plate f = −<N, B1 s_uuuu + (B1 + B2) s_uuvv + B2 s_vvvv> N [Etzmuß 2002, (2.26)], the sign such that it removes
/// energy; each second difference vanishes across its own border, which is the natural condition. Algorithm 4 as printed
/// imposes Δs = 0 there and ignores twist. The thesis' projection onto N changes the sum of the forces: a free sheet then does
/// not keep its momentum (force_symmetry_test); unprojected it does.
std::optional<Term> make_plate(const Sheet& sheet) {
  const Material& m = sheet.material;
  if ((!m.bend.any() && !m.bend_damping.any()) || m.bend_form != BendForm::plate) return {};
  LinearOperators operators{plate_matrix(sheet.grid, m.bend), plate_matrix(sheet.grid, m.bend_damping)};
  return m.bend_projected ? projected(sheet.grid, std::move(operators), sheet.rest) : unprojected(std::move(operators));
}

}  // namespace drape::model
