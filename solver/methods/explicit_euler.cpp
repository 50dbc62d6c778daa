#include "solver/methods/acceleration.hpp"

namespace drape::solver {

// x1 = x0 + h v0,   v1 = v0 + h M⁻¹ f(t0, x0, v0)   [Etzmuß 2002, (3.4)]
// Undamped motion grows with every step, however short.
void explicit_euler(Step& s) {
  const State& y0 = s.y0();
  Vectors& a0 = s.scratch.av;
  acceleration(s.ode, s.t, y0, a0);
  s.y1().x = y0.x + s.h * y0.v;
  s.y1().v = y0.v + s.h * a0;
  s.error.constant = 1.0 / 2;
}

}  // namespace drape::solver
