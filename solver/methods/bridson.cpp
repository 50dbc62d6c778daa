#include "solver/filter.hpp"
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
  undamped.partition = ode.partition;
  undamped.force = [&ode](double time, const Vectors& x, const Vectors& v, Vectors& f) {
    ode.force(time, x, v, f);
    f -= ode.damping * v;
    ode.partition->set_copies(f);
  };
  return verlet_limit(spectrum(undamped, t, y));
}

/// The state is kept at (x1, v at the middle of the sub-step), so that there is one linear system a sub-step: the second half
/// of a sub-step and the first half of the next are   M (v½' − v½) = τ f(t1, x1, (v½ + v½')/2). It is solved by one Newton
/// update with M − τ/2 D from the guess v½' = v½ + δ, where δ is the last change of v½.
bool bridson_sub_steps(Step& s, double tau, double count) {
  State& y = s.y1();
  Vectors &weight = s.scratch.ax, &ahead = s.scratch.av, &f = s.scratch.f_hat, &delta = s.scratch.rates[0].v;
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
    if (k == count) break;
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
  ObliquePins(s.ode.pins)(f);
  y.v.array() += (0.5 * tau) * weight.array() * f.array();
  return true;
}

/// The same where obstacles are near. Constraints act in both halves of a sub-step, which share one evaluation of f(t1, x1, v),
/// with the v that the first half leads to if it lasts. After an impact the second half is implicit as well: both together are
/// L-stable for the damping, which else would ring.
bool bridson_sub_steps_in_contact(Step& s, double tau, double count) {
  State& y = s.y1();
  State& start = s.scratch.rates[0];
  Vectors &weight = s.scratch.ax, &ahead = s.scratch.av, &f = s.scratch.f_hat, &r = s.scratch.rates[1].v;
  const double half = tau / 2;
  const auto damping = [&](const Vectors& v) -> const Vectors& {
    r.setZero(v.rows(), 3);
    if (s.ode.damping.nonZeros() > 0) multiply(s.ode.damping, v, r);
    return r;
  };
  s.ode.force(s.t, y.x, y.v, f);
  f -= damping(y.v);
  for (double k = 0; k < count; ++k) {
    const double t = s.t + k * tau;
    start = y;
    s.contacts->begin_part(t, tau, start);
    const Stage first{.gamma = half, .t = t + half, .ax = start.x, .av = start.v, .springs = false};
    if (!s.accept(s.stage->solve_linear(first, f, y))) return true;
    y.x = start.x + tau * y.v;
    const bool impact = s.contacts->impact();
    s.contacts->finish(y, start);
    ahead = y.v;
    if (!impact) ahead += y.v - start.v;
    s.ode.force(t + tau, y.x, ahead, f);
    s.pass(t + tau, y);
    if (limit_narrowed(s, bridson_step_limit, t + tau, ahead, alternates(s, f, weight))) return false;
    f -= damping(ahead);
    r = half * (damping(y.v) + f);
    s.contacts->add_friction(half, r);
    if (impact) {
      y.v += s.stage->solve_damping(half, r, s.result);
      if (s.result.outcome != Outcome::success) return true;
    } else {
      s.contacts->filter()(r);
      y.v.array() += weight.array() * r.array();
    }
  }
  return true;
}

/// Goes from y0 to y1 in sub-steps inside the current limit; false if it has become narrower.
bool whole_bridson_step(Step& s, double substeps) {
  s.error.constant = 1.0 / (6 * substeps * substeps);
  s.scratch.rates.resize(2);
  inverse_masses(s.ode, s.scratch.ax);
  s.y1() = s.y0();
  const bool contacts = s.contacts != nullptr && !s.contacts->empty();
  return (contacts ? bridson_sub_steps_in_contact : bridson_sub_steps)(s, s.h / substeps, substeps);
}

}  // namespace

// h is divided into equal sub-steps τ inside the stability limit 2/ω, which the constant damping D does not lower, and in each
//   v½ = v0 + τ/2 M⁻¹ f(t0, x0, v½),   x1 = x0 + τ v½,   v1 = v½ + τ/2 M⁻¹ f(t1, x1, v½)   [Bridson, Marino, Fedkiw 2003]
// where D alone is implicit: exact for D, and of second order for damping that is not constant. Without damping this is
// velocity Verlet. Particles that meet an obstacle are constrained in v½, so that x1 is on the border.
void bridson(Step& s) { sub_step(s, bridson_step_limit, whole_bridson_step); }

}  // namespace drape::solver
