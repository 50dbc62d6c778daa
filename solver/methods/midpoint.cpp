#include "solver/step.hpp"

namespace drape::solver {

// y1 = y0 + h f(t0 + h/2, (y0 + y1)/2)   [Etzmuß 2002, (3.26)], solved for the state in the middle:
// ym = y0 + h/2 f(ym),   y1 = 2 ym − y0
void midpoint(Step& s) {
  const State& y0 = s.y0();
  State& ym = s.y1();
  if (!s.solve({s.h / 2, s.t + s.h / 2, y0.x, y0.v}, 1.0 / 12)) return;
  s.y1().x = 2 * ym.x - y0.x;
  s.y1().v = 2 * ym.v - y0.v;
}

}  // namespace drape::solver
