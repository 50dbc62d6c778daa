#include "solver/methods/starts.hpp"

namespace drape::solver {
namespace {

// (M − γ D − γ² K) Δv = M (av − v0) + γ f(t, ax + γ v0, v0),   v = v0 + Δv,   x = ax + γ v with K, D where f is evaluated:
// one Newton step on a stage from the predictor v0   [Etzmuß 2002, (3.32)]
bool newton_step(Step& s, const Stage& stage, double c) {
  State& y = s.y1();
  y.v = s.y0().v;
  y.x = stage.ax + stage.gamma * y.v;
  s.error.constant = c;
  if (!s.linearise(stage.gamma, stage.t, y)) return false;
  Vectors &r = s.scratch.f_hat, &dv = s.scratch.av;
  s.ode.force(stage.t, y.x, y.v, r);
  r = stage.gamma * r + s.ode.mass.asDiagonal() * (stage.av - y.v);
  s.solve_linearised(r, dv);
  y.v += dv;
  y.x += stage.gamma * dv;
  return true;
}

}  // namespace

// BDF(2) (3.35) with one Newton step   [Choi, Ko 2002], begun by one of the implicit midpoint rule (3.26)
void one_newton_bdf2(Step& s) {
  const State& y0 = s.y0();
  s.starting = s.w() == 0;
  if (s.starting) {
    if (!newton_step(s, {s.h / 2, s.t + s.h / 2, y0.x, y0.v}, 1.0 / 12)) return;
    s.y1().x = 2 * s.y1().x - y0.x;
    s.y1().v = 2 * s.y1().v - y0.v;
    return;
  }
  const auto [c1, c2, c3] = bdf2_coefficients(s.w());
  Vectors &ax = s.scratch.ax, &av = s.scratch.av;
  ax = c1 * y0.x - c2 * s.ym1().x;
  av = c1 * y0.v - c2 * s.ym1().v;
  newton_step(s, {c3 * s.h, s.t + s.h, ax, av}, bdf2_error(s.w()));
}

}  // namespace drape::solver
