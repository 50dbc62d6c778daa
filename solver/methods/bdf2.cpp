#include "solver/methods/starts.hpp"

namespace drape::solver {

// x1 = c3 h v1 + c1 x0 − c2 x₋₁,   M v1 = M (c1 v0 − c2 v₋₁) + c3 h f(t1, x1, v1)   [Etzmuß 2002, (3.35)–(3.36)]
void bdf2(Step& s) {
  const double w = s.w();
  s.starting = w == 0;
  if (s.starting) return s.after_impact ? implicit_euler(s) : midpoint(s);  // a first step that damps, or one of second order
  const auto [c1, c2, c3] = bdf2_coefficients(w);
  Vectors &ax = s.scratch.ax, &av = s.scratch.av;
  ax = c1 * s.y0().x - c2 * s.ym1().x;
  av = c1 * s.y0().v - c2 * s.ym1().v;
  s.solve({c3 * s.h, s.t + s.h, ax, av}, bdf2_error(w));
}

}  // namespace drape::solver
