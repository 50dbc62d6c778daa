#include "solver/step.hpp"

namespace drape::solver {

// (M − h D − h² K) Δv = h (f0 + h K v0),   v1 = v0 + Δv,   x1 = x0 + h v1 with K = ∂f/∂x, D = ∂f/∂v and f0 at (t1, x0, v0)
// [Baraff, Witkin 1998; Etzmuß 2002, 3.2], which is the first iteration of Newton's method on implicit Euler
void baraff_witkin(Step& s) {
  const State& y0 = s.y0();
  const double h = s.h, t1 = s.t + h;
  Vectors &f0 = s.scratch.f_hat, &K_v0 = s.scratch.ax, &dv = s.scratch.av;
  s.error.constant = 1.0 / 2;
  if (!s.linearise(h, t1, y0)) return;
  s.ode.force(t1, y0.x, y0.v, f0);
  s.linearised->multiply_stiffness(y0.v, K_v0);
  f0 = h * (f0 + h * K_v0);
  s.solve_linearised(f0, dv);
  s.y1().v = y0.v + dv;
  s.y1().x = y0.x + h * s.y1().v;
}

}  // namespace drape::solver
