#include "model/forces/linear_operator.hpp"
#include "model/forces/term.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {
namespace {

bool on_border(const Grid& grid, int i, const Edge& edge) {
  return edge.weft ? i % grid.nu == 0 || i % grid.nu == grid.nu - 1 : i < grid.nu || i >= grid.nu * (grid.nv - 1);
}

/// The matrix of Σ_edges b/l² (x_j − x_i), with b of the edge's direction; with `is_border`, edges that end on a border leave
/// their particle there alone.
SparseMatrix laplacian(const Grid& grid, const WeftWarp& b, bool is_border) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Edge& edge : edges(grid)) {
    const double weight = along(b, edge) / (edge.length * edge.length);
    if (weight == 0) continue;
    for (const auto& [i, j] : {std::pair(edge.i, edge.j), std::pair(edge.j, edge.i)}) {
      if (is_border && on_border(grid, i, edge)) continue;
      entries.emplace_back(i, j, weight);
      entries.emplace_back(i, i, -weight);
    }
  }
  SparseMatrix matrix(grid.particles(), grid.particles());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Minus the Laplacian of the Laplacian, times the area of a particle: the algorithm gives force densities.
SparseMatrix printed_plate_matrix(const Grid& grid, const WeftWarp& B, bool is_border) {
  const SparseMatrix bilaplacian = laplacian(grid, B, is_border) * laplacian(grid, {1, 1}, is_border);
  return -(grid.cell_areas().asDiagonal() * bilaplacian);
}

}  // namespace

/// Thin plate as printed: the Laplacian over the edges of a particle, and the Laplacian of that [Etzmuß 2002, Alg. 4], with the
/// sign that removes energy. On free borders it imposes Δs = 0, and it lacks twist: for comparison only. The thesis' program
/// computes "on the border no bend forces in the normal direction of that border" (6.2.1): there no edge across a border acts
/// on it.
std::optional<Term> make_printed_plate(const Sheet& sheet) {
  const Material& m = sheet.material;
  const bool is_border = m.bend_form == BendForm::printed_is_border;
  if ((!m.bend.any() && !m.bend_damping.any()) || (m.bend_form != BendForm::printed && !is_border)) return {};
  return projected(
      sheet.grid,
      {printed_plate_matrix(sheet.grid, m.bend, is_border), printed_plate_matrix(sheet.grid, m.bend_damping, is_border)},
      sheet.rest);
}

}  // namespace drape::model
