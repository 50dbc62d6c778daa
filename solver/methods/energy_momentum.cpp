#include "solver/step.hpp"

namespace drape::solver {

// M (v1 − v0) = h f̄(x0, x1, (v0 + v1)/2),   x1 = x0 + h (v0 + v1)/2 with the mean force f̄ of a discrete gradient: the potential
// energy changes by −<f̄, x1 − x0> exactly   [Simo, Tarnow 1992; Gonzalez 1996], solved for the state in the middle.
void energy_momentum(Step& s) {
  const State& y0 = s.y0();
  State& ym = s.y1();
  if (!s.solve({.gamma = s.h / 2, .t = s.t + s.h / 2, .ax = y0.x, .av = y0.v, .start = &y0.x}, 1.0 / 12)) return;
  s.y1().x = 2 * ym.x - y0.x;
  s.y1().v = 2 * ym.v - y0.v;
}

}  // namespace drape::solver
