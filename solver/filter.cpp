#include "solver/filter.hpp"

namespace drape::solver {
namespace {

/// Projector on the coordinates that a pin leaves free.
Eigen::Matrix3d free_directions(const Pin& pin) {
  Eigen::Matrix3d free = Eigen::Matrix3d::Identity();
  for (int c = 0; c < 3; ++c)
    if (pin.fixed[c]) free(c, c) = 0;
  return free;
}

}  // namespace

Filter Filter::partial(const std::vector<Pin>& pins) {
  Filter filter;
  for (const Pin& pin : pins)
    if (!pin.all()) filter.add(pin.particle, free_directions(pin));
  return filter;
}

std::vector<Eigen::Matrix3d> allowed_directions(const SplitOde& ode) {
  std::vector<Eigen::Matrix3d> allowed;
  if (ode.pins.empty()) return allowed;
  allowed.assign(ode.particles(), Eigen::Matrix3d::Identity());
  for (const Pin& pin : ode.pins) allowed[pin.particle] = free_directions(pin);
  return allowed;
}

}  // namespace drape::solver
