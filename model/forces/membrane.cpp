#include <algorithm>

#include "model/forces/linear_operator.hpp"
#include "model/forces/term.hpp"

namespace drape::model {
namespace {

/// The matrix of A (B1 s_uu + B2 s_vv). A border particle takes the curvature of its inner neighbour: zero curvature there
/// would make it first order.
SparseMatrix membrane_matrix(const Grid& grid, const WeftWarp& B) {
  const Metric metric(grid);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int i, const LineDifference& difference, double modulus) {
    const double weight = metric.area(i) * modulus / (difference.length * difference.length);
    for (const auto& [particle, coefficient] : difference.entries)
      if (weight * coefficient != 0) entries.emplace_back(i, particle, coefficient * weight);
  };
  for (int b = 0; b < grid.nv; ++b)
    for (int a = 0; a < grid.nu; ++a) {
      const int i = grid.index(a, b);
      if (grid.nu > 2) add(i, metric.second_difference(std::clamp(a, 1, grid.nu - 2), b, true), B.weft);
      if (grid.nv > 2) add(i, metric.second_difference(a, std::clamp(b, 1, grid.nv - 2), false), B.warp);
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
