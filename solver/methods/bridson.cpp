#include "solver/linear/kernels.hpp"
#include "solver/methods/sub_steps.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

/// That of `verlet` without the damping D, which is implicit: 2/ω if there is no other.
double bridson_step_limit(const SplitOde& ode, double t, const State& y) {
  if (ode.damping.nonZeros() == 0) return verlet_limit(spectrum(ode, t, y));
  SplitOde undamped;
  undamped.mass = ode.mass;
  undamped.pins = ode.pins;
  undamped.force = [&ode](double time, const Vectors& x, const Vectors& v, Vectors& f) {
    ode.force(time, x, v, f);
    f -= ode.damping * v;
  };
  return verlet_limit(spectrum(undamped, t, y));
}

/// Goes from y0 to y1, whose v is that of the middles of sub-steps until the end.
bool whole_bridson_step(Step& s, double substeps) {
  const double tau = s.h / substeps;
  s.error.constant = 1.0 / (6 * substeps * substeps);
  s.scratch.rates.resize(1);
  State& y = s.y1();
  Vectors &weight = s.scratch.ax, &ahead = s.scratch.av, &f = s.scratch.f_hat, &delta = s.scratch.rates[0].v;
  inverse_masses(s.ode, weight);
  y = s.y0();
  s.ode.force(s.t, y.x, y.v, f);
  f *= tau / 2;
  const Vectors& half = s.stage->solve_damping(tau / 2, f, s.result);
  if (s.result.outcome != Outcome::success) return true;
  y.v += half;
  delta = 2 * half;
  for (double k = 1;; ++k) {
    y.x += tau * y.v;
    ahead = y.v + 0.5 * delta;
    s.ode.force(s.t + k * tau, y.x, ahead, f);
    s.pass(s.t + k * tau, y);
    if (limit_narrowed(s, bridson_step_limit, s.t + k * tau, ahead, alternates(s, f, weight))) return false;
    if (k == substeps) break;
    f.array() = tau * f.array() - delta.array().colwise() * s.ode.mass.array();
    delta += s.stage->solve_damping(tau / 2, f, s.result);
    if (s.result.outcome != Outcome::success) return true;
    y.v += delta;
  }
  if (s.ode.damping.nonZeros() > 0) {
    ahead = 0.5 * delta;
    multiply(s.ode.damping, ahead, delta);
    f -= delta;
  }
  y.v.array() += (0.5 * tau) * weight.array() * f.array();
  return true;
}

}  // namespace

// h is divided into equal sub-steps τ inside the stability limit 2/ω, which the constant damping D does not lower, and in each
//   v½ = v0 + τ/2 M⁻¹ f(t0, x0, v½),   x1 = x0 + τ v½,   v1 = v½ + τ/2 M⁻¹ f(t1, x1, v½)   [Bridson, Marino, Fedkiw 2003]
// where D alone is implicit: one linear system with M − τ/2 D. Without damping this is velocity Verlet.
// The second half of a sub-step and the first half of the next are one equation,   M (v½' − v½) = τ f(t1, x1, (v½ + v½')/2).
// It is solved by one Newton update with M − τ/2 D from the guess v½' = v½ + δ, where δ is the last change of v½: exact for D,
// and of second order for damping that is not constant.
void bridson(Step& s) { sub_step(s, bridson_step_limit, whole_bridson_step); }

}  // namespace drape::solver
