#include <memory>
#include <vector>

#include "model/forces/term.hpp"
#include "model/sheet/strain.hpp"

namespace drape::model {
namespace {

/// A curvature of a sheet, and the moment that it has at rest [N].
struct AtRest {
  Strain curvature;
  double value, moment;
};

std::vector<AtRest> curvatures_at_rest(const Sheet& sheet) {
  const Grid& grid = sheet.grid;
  const WeftWarp& B = sheet.material.bend;
  std::vector<AtRest> all;
  const auto add = [&](const Strain& curvature, double stiffness) {
    const double value = curvature.value(sheet.rest);
    if (stiffness * value != 0) all.push_back({curvature, value, stiffness * value});
  };
  for (const auto& [curvature, weft] : line_curvatures(grid)) add(curvature, weft ? B.weft : B.warp);
  const Metric metric(grid);
  for (const Cell& cell : cells(grid)) add(Strain::of_twist(metric, cell), B.weft + B.warp);
  return all;
}

}  // namespace

/// A plate that rests curved has the energy ½ B (κ − κ_r)² of its normal curvatures [Etzmuß 2002, 2.3.5: II_s − II_r] instead
/// of ½ B κ²: the difference ½ B κ_r² − B κ_r κ, the force B κ_r ∂κ/∂x.
std::optional<Term> make_rest_curvature(const Sheet& sheet) {
  const Material& m = sheet.material;
  if (sheet.rest.size() == 0 || m.bend_form != BendForm::plate || m.bend_projected) return {};
  const auto all = std::make_shared<const std::vector<AtRest>>(curvatures_at_rest(sheet));
  if (all->empty()) return {};

  Term term;
  term.without_energy = true;  // it has one, but no mean force
  term.force = [=](const Configuration& c, Vectors& f) {
    Strain::Gradient by;
    for (const auto& [curvature, value, moment] : *all) {
      curvature.value(c.x, by);
      curvature.add_force(-moment, by, f);
    }
  };
  term.energy = [=](const Vectors& x) {
    double energy = 0;
    for (const auto& [curvature, value, moment] : *all)
      energy += curvature.area() * moment * (0.5 * value - curvature.value(x));
    return energy;
  };
  term.jacobian = [=](const Configuration& c, const JacobianEntries& entries) {
    if (!entries.exact()) return;  // indefinite
    Strain::Gradient by;
    for (const auto& [curvature, value, moment] : *all) {
      curvature.value(c.x, by);
      curvature.add_jacobian(c.x, -moment, 0, by, entries.add_dx);
    }
  };
  return term;
}

}  // namespace drape::model
