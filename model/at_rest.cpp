#include "model/at_rest.hpp"

#include <algorithm>

#include "model/cloth.hpp"

namespace drape::model {
namespace {

/// By what needs no forces.
bool is_driven(const Scene& scene) {
  const bool pulled = std::ranges::any_of(scene.pins, [](const PinRule& rule) { return !rule.velocity.isZero(0); });
  const bool pushed = std::ranges::any_of(scene.obstacles, [](const ObstacleRule& rule) { return moves(rule); });
  const bool thrown = std::ranges::any_of(scene.panels, [](const PanelRule& panel) { return !panel.start.velocity.isZero(0); });
  return pulled || pushed || thrown || !scene.sheet.gravity.isZero(0) || scene.sheet.wind.blows() ||
         !scene.sheet.added.empty() || !scene.start.velocity.isZero(0);
}

}  // namespace

bool is_at_rest(const Scene& scene) {
  constexpr double negligible = 1e-9;
  if (is_driven(scene)) return false;
  const Cloth cloth = compile(scene);
  const solver::SplitOde& ode = cloth.ode;
  Vectors force(ode.particles(), 3);
  ode.force(0, cloth.start.x, cloth.start.v, force);
  solver::filter(ode.pins, force);
  const double acceleration = (ode.mass.cwiseInverse().asDiagonal() * force).rowwise().norm().maxCoeff();
  return 0.5 * acceleration * scene.end * scene.end <= negligible * size(scene);
}

}  // namespace drape::model
