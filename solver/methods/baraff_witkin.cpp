#include <algorithm>

#include "solver/step.hpp"

namespace drape::solver {
namespace {

/// h (f0 + h K v0) for the K that was made last.
Vectors& right_side(Step& s) {
  const double h = s.h;
  Vectors &f0 = s.scratch.f_hat, &K_v0 = s.scratch.ax;
  s.error.constant = 1.0 / 2;
  s.ode.force(s.t + h, s.y0().x, s.y0().v, f0);
  s.linearised->multiply_stiffness(s.y0().v, K_v0);
  f0 = h * (f0 + h * K_v0);
  return f0;
}

void move_by(Step& s, const Vectors& dv) {
  s.y1().v = s.y0().v + dv;
  s.y1().x = s.y0().x + s.h * s.y1().v;
}

}  // namespace

// (M − h D − h² K) Δv = h (f0 + h K v0),   v1 = v0 + Δv,   x1 = x0 + h v1 with K = ∂f/∂x, D = ∂f/∂v and f0 at (t1, x0, v0)
// [Baraff, Witkin 1998; Etzmuß 2002, 3.2], which is the first iteration of Newton's method on implicit Euler
void baraff_witkin(Step& s) {
  if (!s.linearise(s.h, s.t + s.h, s.y0())) return;
  s.solve_linearised(right_side(s), s.scratch.av);
  move_by(s, s.scratch.av);
}

// The same system, or that of its symmetric part where damping turns with the sheet, by filtered conjugate gradients with a
// block-Jacobi preconditioner. Its residual is `cg_tolerance` of the right-hand side's norm. As in the paper nothing is done
// about matrices that compressed edges make indefinite: there the iteration may not end.
void baraff_witkin_cg(Step& s) {
  s.result.outcome = s.linearised->assemble(s.h, s.t + s.h, s.y0());
  if (s.result.outcome != Outcome::success) return;
  const double tolerance = std::max(s.options.cg_tolerance, StageSystem::round_off(1));
  const LinearResult solved =
      s.linearised->solve_symmetric(right_side(s), tolerance, s.options.max_cg_iterations, s.scratch.av);
  s.result.outcome = solved.outcome;
  s.result.cg_iterations += solved.iterations;
  ++s.result.updates;
  move_by(s, s.scratch.av);
}

}  // namespace drape::solver
