#include "solver/methods/projection.hpp"
#include "solver/step.hpp"

namespace drape::solver {
namespace {

void project_in_sub_steps(Step& s, void (Projection::*sweep)(Vectors&)) {
  Projection& projection = s.keep<Projection>();
  const SplitOde::Force& force = s.ode.unconstrained_force ? s.ode.unconstrained_force : s.ode.force;
  const double tau = s.h / s.options.sub_steps;
  Vectors &f = s.scratch.f_hat, &before = s.scratch.ax;
  State& y = s.y1();
  s.error.constant = 0.5 / s.options.sub_steps;
  y = s.y0();
  for (int k = 0; k < s.options.sub_steps; ++k) {
    force(s.t + k * tau, y.x, y.v, f);
    f *= tau;
    y.v += s.stage->solve_damping(tau, f, s.result);
    if (s.result.outcome != Outcome::success) return;
    before = y.x;
    y.x += tau * y.v;
    projection.begin(tau);
    for (int n = 0; n < s.options.sweeps; ++n) (projection.*sweep)(y.x);
    y.v = (y.x - before) / tau;
    prescribe(s.ode.pins, y.v);
    s.pass(s.t + (k + 1) * tau, y);
  }
}

}  // namespace

// h is divided into equal sub-steps τ, and in each, with the force f̂ of all that is neither a constraint nor D v,
//   (M − τ D) v* = M v0 + τ f̂(t0, x0, v0),   x1 = projection of x0 + τ v*,   v1 = (x1 − x0)/τ
// [Macklin, Müller, Chentanez 2016; Macklin et al. 2019 for one sweep a sub-step]. Sweeps without end would make this nearly
// implicit Euler for the constraints. Damping is not a constraint, and other forces are explicit: they limit the sub-steps.
void xpbd(Step& s) { project_in_sub_steps(s, &Projection::sweep); }
void xpbd_jacobi(Step& s) { project_in_sub_steps(s, &Projection::sweep_at_once); }

}  // namespace drape::solver
