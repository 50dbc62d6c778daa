#include "solver/step.hpp"

namespace drape::solver {

// Implicit midpoint rule on K x + D v, explicit one on f_expl: ARS(1,2,2)   [Etzmuß 2002, 3.4.1; Ascher et al. 1997]
//   M vm = M v0 + h/2 (K xm + D vm + f_expl(y0)),   xm = x0 + h/2 vm
//   M v1 = M v0 + h (K xm + D vm + f_expl(ym)) = M (2 vm − v0) + h (f_expl(ym) − f_expl(y0)),   x1 = 2 xm − x0
void imex_midpoint(Step& s) {
  const State& y0 = s.y0();
  const Vectors& f0 = s.explicit_force(s.now(), s.t);
  State& ym = s.y1();
  ym.v = y0.v;
  s.error.constant = 1.0 / 12;
  if (!s.accept(s.stage->solve_linear({s.h / 2, s.t + s.h / 2, y0.x, y0.v}, f0, ym))) return;
  Vectors& df = s.scratch.f_hat;
  s.ode.explicit_force(s.t + s.h / 2, ym.x, ym.v, df);
  df -= f0;
  filter(s.ode.pins, df);
  s.y1().x = 2 * ym.x - y0.x;
  s.y1().v = 2 * ym.v - y0.v + s.h * (s.ode.mass.cwiseInverse().asDiagonal() * df);
}

}  // namespace drape::solver
