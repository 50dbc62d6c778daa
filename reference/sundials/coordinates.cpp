#include "reference/sundials/coordinates.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace drape::reference {

Coordinates::Coordinates(const solver::SplitOde& ode) : unknown(3 * ode.mass.size(), -1), place(3 * ode.mass.size(), -1) {
  std::vector<bool> is_free(unknown.size(), true);
  for (const solver::Pin& pin : ode.pins)
    for (int c = 0; c < 3; ++c) is_free[3 * pin.particle + c] = !pin.fixed(c);
  for (int i = 0; i < std::ssize(unknown); ++i) {
    std::vector<int>& kind = is_free[i] ? free : pinned;
    (is_free[i] ? unknown : place)[i] = static_cast<int>(kind.size());
    kind.push_back(i);
  }
  if (free.empty()) throw std::invalid_argument("every coordinate is pinned: there is no equation of motion to integrate");
}

solver::State prescribed_start(const solver::SplitOde& ode, const solver::State& start) {
  if (start.x.rows() != ode.particles() || start.v.rows() != ode.particles())
    throw std::invalid_argument(fmt::format("the start has {} positions and {} velocities, the equation of motion {} particles",
                                            start.x.rows(), start.v.rows(), ode.particles()));
  solver::State result = start;
  solver::prescribe(ode.pins, result.v);
  if (ode.memory && result.z.size() == 0) result.z.setZero(ode.memory->variables());
  return result;
}

}  // namespace drape::reference
