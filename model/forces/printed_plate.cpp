#include "model/forces/linear_operator.hpp"
#include "model/forces/term.hpp"
#include "model/sheet/edges.hpp"

namespace drape::model {
namespace {

/// The matrix of Σ_edges b/l² (x_j − x_i), with b of the edge's direction.
SparseMatrix laplacian(const Grid& grid, const WeftWarp& b) {
  return spring_matrix(grid, [&](const Edge& edge) { return along(b, edge) / (edge.length * edge.length); });
}

/// Minus the Laplacian of the Laplacian, times the area of a particle: the algorithm gives force densities.
SparseMatrix printed_plate_matrix(const Grid& grid, const WeftWarp& B) {
  const SparseMatrix bilaplacian = laplacian(grid, B) * laplacian(grid, {1, 1});
  return -(grid.cell_areas().asDiagonal() * bilaplacian);
}

}  // namespace

/// Thin plate as printed: the Laplacian over the edges of a particle, and the Laplacian of that [Etzmuß 2002, Alg. 4], with the
/// sign that removes energy. On free borders it imposes Δs = 0, and it lacks twist: for comparison only.
std::optional<Term> make_printed_plate(const Sheet& sheet) {
  const Material& m = sheet.material;
  if ((!m.bend.any() && !m.bend_damping.any()) || m.bend_form != BendForm::printed) return {};
  return projected(sheet.grid, {printed_plate_matrix(sheet.grid, m.bend), printed_plate_matrix(sheet.grid, m.bend_damping)});
}

}  // namespace drape::model
