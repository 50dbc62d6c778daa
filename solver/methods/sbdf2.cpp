#include "solver/methods/starts.hpp"

namespace drape::solver {

// A v1 = M (c1 v0 − c2 v₋₁) + c3 h K (c1 x0 − c2 x₋₁) + c3 h f̂,   x1 = c3 h v1 + c1 x0 − c2 x₋₁,
// A = M − (c3 h)² K − c3 h D,   f̂ = (1 + w) f_expl(x0, v0) − w f_expl(x₋₁, v₋₁)   [Etzmuß 2002, (3.29)–(3.31)]
// The thesis prints f̂ = 2 f0 − f₋₁, which is right for w = 1 only.
void sbdf2(Step& s) {
  const double w = s.w();
  s.starting = w == 0;
  if (s.starting) return s.after_impact ? imex_euler(s) : imex_midpoint(s);  // a first step that damps, or one of second order
  const auto [c1, c2, c3] = bdf2_coefficients(w);
  Vectors &ax = s.scratch.ax, &av = s.scratch.av;
  ax = c1 * s.y0().x - c2 * s.ym1().x;
  av = c1 * s.y0().v - c2 * s.ym1().v;
  Vectors& f_hat = s.scratch.f_hat;
  f_hat = (1 + w) * s.explicit_force(s.now(), s.t) - w * s.explicit_force(s.history[1], s.t - s.h / w);
  s.solve_split({c3 * s.h, s.t + s.h, ax, av}, f_hat, bdf2_error(w));
}

}  // namespace drape::solver
