#include "model/forces/linear_operator.hpp"
#include "model/forces/term.hpp"

namespace drape::model {
namespace {

/// The matrix of the force −∇E for E = ½ Σ A (B1 |D²_u x|² + B2 |D²_v x|²) + ½ Σ_cells A (B1 + B2) |D_u D_v x|².
SparseMatrix plate_matrix(const Grid& grid, const WeftWarp& B) {
  const Metric metric(grid);
  std::vector<Eigen::Triplet<double>> entries;
  const auto along = [&](int a, int b, bool weft) {
    const auto [stencil, l] = metric.second_difference(a, b, weft);
    add_quadratic(entries, stencil, metric.bent_area(a, b, weft) * (weft ? B.weft : B.warp) / (l * l * l * l));
  };
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      for (const bool weft : {true, false})
        if (metric.bends(a, b, weft)) along(a, b, weft);
      if (a == 0 || b == 0) continue;
      const Cell cell = cell_at(grid, a - 1, b - 1);
      const auto [stencil, lu, lv] = metric.mixed_difference(cell);
      const double size = lu * lv;
      add_quadratic(entries, stencil, (B.weft + B.warp) / size * (metric.area(cell) / size));
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
