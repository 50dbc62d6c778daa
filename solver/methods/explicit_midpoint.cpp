#include "solver/methods/acceleration.hpp"

namespace drape::solver {

// y1 = y0 + h F(t0 + h/2, ym),   ym = y0 + h/2 F(t0, y0)   with F = (v, M⁻¹ f)   [Etzmuß 2002, 3.4.1]
// Undamped motion grows with every step, however short.
void explicit_midpoint(Step& s) {
  const State& y0 = s.y0();
  State& ym = s.y1();
  Vectors& a = s.scratch.av;
  acceleration(s.ode, s.t, y0, a);
  ym.x = y0.x + s.h / 2 * y0.v;
  ym.v = y0.v + s.h / 2 * a;
  acceleration(s.ode, s.t + s.h / 2, ym, a);
  s.y1().x = y0.x + s.h * ym.v;
  s.y1().v = y0.v + s.h * a;
  s.error.constant = 1.0 / 6;
}

}  // namespace drape::solver
