#include "solver/split_ode.hpp"

namespace drape::solver {

double kinetic_energy(const SplitOde& ode, const Vectors& v) { return 0.5 * ode.mass.dot(v.rowwise().squaredNorm()); }

double stored_energy(const SplitOde& ode, double t, const State& y) {
  return ode.potential_energy(t, y.x) + (ode.memory ? ode.memory->energy(y) : 0);
}

void prescribe(const std::vector<Pin>& pins, Vectors& v) {
  for (const Pin& pin : pins)
    for (int c = 0; c < 3; ++c)
      if (pin.fixed[c]) v(pin.particle, c) = pin.velocity[c];
}

void filter(const std::vector<Pin>& pins, Vectors& r) {
  for (const Pin& pin : pins)
    for (int c = 0; c < 3; ++c)
      if (pin.fixed[c]) r(pin.particle, c) = 0;
}

Vectors reactions(const SplitOde& ode, double t, const State& y) {
  Vectors f(ode.particles(), 3);
  ode.force(t, y.x, y.v, f);
  Vectors free = f;
  filter(ode.pins, free);
  return free - f;
}

}  // namespace drape::solver
