#include "solver/split_ode.hpp"

namespace drape::solver {

double kinetic_energy(const SplitOde& ode, const Vectors& v) { return 0.5 * ode.mass.dot(v.rowwise().squaredNorm()); }

double stored_energy(const SplitOde& ode, double t, const State& y) {
  return ode.potential_energy(t, y.x) + (ode.memory ? ode.memory->energy(y) : 0) +
         (ode.step_forces ? ode.step_forces->energy(t, y.x) : 0);
}

void prescribe(const std::vector<Pin>& pins, Vectors& v) {
  for (const Pin& pin : pins) {
    auto own = v.row(pin.particle);
    if (pin.all())
      own = pin.velocity.transpose();
    else
      own = (own * pin.free() + pin.prescribed().transpose()).eval();
  }
}

void filter(const std::vector<Pin>& pins, Vectors& r) {
  for (const Pin& pin : pins) {
    auto own = r.row(pin.particle);
    if (pin.all())
      own.setZero();
    else
      own *= pin.free();
  }
}

Vectors reactions(const SplitOde& ode, double t, const State& y) {
  Vectors f(ode.particles(), 3);
  ode.force(t, y.x, y.v, f);
  Vectors free = f;
  filter(ode.pins, free);
  return free - f;
}

}  // namespace drape::solver
