#include <cmath>
#include <memory>
#include <vector>

#include "model/forces/term.hpp"
#include "model/sheet/cells.hpp"
#include "model/sheet/strain.hpp"

namespace drape::model {
namespace {

/// A strain with the energy ½ E ε² by area.
struct Elastic {
  Strain strain;
  double modulus;  ///< E [N/m]
};

/// The diagonal of a cell as an edge that stands for some of its area.
Elastic diagonal(const Grid& grid, EdgeEnds ends, double share, double G) {
  const double area = grid.spacing_u() * grid.spacing_v(), length = std::hypot(grid.spacing_u(), grid.spacing_v());
  const double stretch = length * length / area;  // shear over the stretch of a diagonal
  return {Strain::of_edge({ends.begin, ends.end, false, length, share * area / length}), G * stretch * stretch};
}

std::vector<Elastic> elements(const Grid& grid, ShearForm form, double G) {
  std::vector<Elastic> all;
  const Metric metric(grid);
  for (const Cell& cell : cells(grid)) {
    const EdgeEnds falling{cell.corner[1][0], cell.corner[0][1]}, rising{cell.corner[0][0], cell.corner[1][1]};
    const auto corners = quadrants(cell);
    switch (form) {
      case ShearForm::conservative:
      case ShearForm::printed: break;
      case ShearForm::diagonals:
        all.push_back(diagonal(grid, falling, 0.5, G));
        all.push_back(diagonal(grid, rising, 0.5, G));
        break;
      case ShearForm::triangles: all.push_back(diagonal(grid, falling, 1, G)); break;
      case ShearForm::hinges:
        for (const auto& [p, q] : corners) all.push_back({Strain::of_angle(metric, cell, p, q), G});
        break;
      case ShearForm::baraff_witkin:
        for (const auto& [p, q] : {corners.front(), corners.back()})
          all.push_back({Strain::of_quadrant(metric, cell, p, q), 2 * G});
        break;
    }
  }
  return all;
}

}  // namespace

/// Shear as in the models that the thesis surveys (2.1.2), for comparison, each with the constant that gives it the shear
/// modulus G on a uniform grid with spacings l_u, l_v and L² = l_u² + l_v²:
///   diagonals      springs along both diagonals of a cell, of κ = G L²/(2 l_u l_v) [N/m]   [Provot 1995]
///   triangles      springs along one diagonal of a cell, of κ = G L²/(l_u l_v)
///   hinges         ½ C (φ − π/2)² of the angles φ at each particle, with C = G l_u l_v/4 [N m]   [Breen, House, Wozny 1994]
///   baraff_witkin  ½ k A² <w_u, w_v>² of the triangles of area A, with k = 2 G/(l_u l_v) [N/m³]   [Baraff, Witkin 1998]
std::optional<Term> make_survey_shear(const Sheet& sheet) {
  const auto all =
      std::make_shared<const std::vector<Elastic>>(elements(sheet.grid, sheet.material.shear_form, sheet.material.shear));
  if (all->empty() || sheet.material.shear == 0) return {};

  Term term;
  term.without_energy = true;  // it has one, but no mean force
  term.force = [=](const Configuration& c, Vectors& f) {
    Strain::Gradient by;
    for (const auto& [strain, modulus] : *all) strain.add_force(modulus * strain.value(c.x, by), by, f);
  };
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const auto& [strain, modulus] : *all) {
      const double value = strain.value(x);
      energy += 0.5 * strain.area() * modulus * value * value;
    }
    return energy;
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    if (entries.curvature == Curvature::tension) return;
    Strain::Gradient by;
    for (const auto& [strain, modulus] : *all) {
      const double stress = modulus * strain.value(c.x, by);
      strain.add_jacobian(c.x, entries.exact() ? stress : 0, modulus, by, entries.add_dx);
    }
  };
  return term;
}

}  // namespace drape::model
