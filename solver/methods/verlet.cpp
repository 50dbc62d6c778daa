#include "solver/filter.hpp"
#include "solver/methods/sub_steps.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

double verlet_step_limit(const SplitOde& ode, double t, const State& y) { return verlet_limit(spectrum(ode, t, y)); }

bool narrowed(Step& s, double t, const Vectors& f) {
  return limit_narrowed(s, verlet_step_limit, t, s.scratch.av, alternates(s, f, s.scratch.ax));
}

/// The state is kept at (x1, v at the middle of the sub-step), so that there is one pass over memory between two evaluations of
/// the force. False if the limit has become narrower meanwhile.
bool sub_steps(Step& s, double tau, double count) {
  const ObliquePins oblique(s.ode.pins);
  const Eigen::Index n = s.scratch.ax.size();
  const double* const w = s.scratch.ax.data();
  const double* const f = s.next.f.data();
  double* const x = s.y1().x.data();
  double* const v = s.y1().v.data();
  double* const ahead = s.scratch.av.data();  // the velocity that a1 is evaluated with
  const auto advance = [=](double kick) {
#pragma GCC ivdep
    for (Eigen::Index i = 0; i < n; ++i) {
      const double a = w[i] * f[i], middle = v[i] + kick * a;
      v[i] = middle;
      x[i] += tau * middle;
      ahead[i] = middle + (0.5 * tau) * a;
    }
  };
  oblique(s.next.f);
  for (double k = 1; k <= count; ++k) {
    advance(k == 1 ? 0.5 * tau : tau);
    s.ode.force(s.t + k * tau, s.y1().x, s.scratch.av, s.next.f);
    oblique(s.next.f);
    s.pass(s.t + k * tau, s.y1());
    if (narrowed(s, s.t + k * tau, s.next.f)) return false;
  }
  s.y1().v.array() += (0.5 * tau) * s.scratch.ax.array() * s.next.f.array();
  return true;
}

/// The same with the impulses of obstacles between the parts of a sub-step.
bool sub_steps_with_impacts(Step& s, double tau, double count) {
  State& y = s.y1();
  const ObliquePins oblique(s.ode.pins);
  Vectors& a = s.next.f;
  oblique(a);
  a.array() *= s.scratch.ax.array();
  s.sub_stepping.impacts->push_out(0, y.x);
  s.sub_stepping.impacts->stop(tau, true, y.v, a);
  for (double k = 1; k <= count; ++k) {
    y.x += tau * y.v + (0.5 * tau * tau) * a;
    s.sub_stepping.impacts->push_out(k * tau, y.x);
    y.v += (0.5 * tau) * a;                // the half of a0
    s.scratch.av = y.v + (0.5 * tau) * a;  // the velocity that a1 is evaluated with
    s.ode.force(s.t + k * tau, y.x, s.scratch.av, a);
    oblique(a);
    s.pass(s.t + k * tau, y);
    if (narrowed(s, s.t + k * tau, a)) return false;
    a.array() *= s.scratch.ax.array();
    y.v += (0.5 * tau) * a;
    s.sub_stepping.impacts->stop(tau, false, y.v, a);
  }
  return true;
}

/// Computes y1 from y0 in sub-steps inside the current limit; false if it has become narrower.
bool whole_step(Step& s, double substeps) {
  const double tau = s.h / substeps;
  State& y = s.y1();
  y = s.y0();
  prescribe(s.ode.pins, y.v);
  inverse_masses(s.ode, s.scratch.ax);
  if (s.now().has_f)
    s.next.f = s.now().f;
  else
    s.ode.force(s.t, y.x, y.v, s.next.f);
  const bool contacts = s.sub_stepping.impacts != nullptr && !s.sub_stepping.impacts->empty();
  s.next.has_f = !contacts;  // the obstacles' reactions were subtracted from it
  s.error.constant = 1.0 / (6 * substeps * substeps);
  return (contacts ? sub_steps_with_impacts : sub_steps)(s, tau, substeps);
}

}  // namespace

// h is divided into equal sub-steps τ inside the stability limit, and in each
//   x1 = x0 + τ v0 + τ²/2 a0,   a1 = a(t1, x1, v0 + τ a0),   v1 = v0 + τ/2 (a0 + a1)
// which is velocity Verlet where forces do not depend on velocities and of second order where they do, with one
// evaluation a sub-step   [Verlet 1967; Groot, Warren 1997, λ = 1].
// The limit is that of the initial state until neighbours have moved apart by a tenth, or modes alternate and grow: then it is
// estimated again, and if it has become narrower the step is repeated.
void verlet(Step& s) { sub_step(s, verlet_step_limit, whole_step); }

}  // namespace drape::solver
