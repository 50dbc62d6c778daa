#include <cmath>

#include "solver/methods/acceleration.hpp"
#include "solver/methods/sub_steps.hpp"
#include "solver/stability.hpp"

namespace drape::solver {
namespace {

/// A step of τ from y at time t, with memory for a stage and its rate.
struct Rk4 {
  State &stage, &change;
  Vectors& a;

  void operator()(const SplitOde& ode, double t, double tau, State& y) const {
    constexpr double c[] = {0, 0.5, 0.5, 1}, b[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    stage = y;
    for (int i = 0; i < 4; ++i) {
      acceleration(ode, t + c[i] * tau, stage, a);
      if (i == 0) {
        change.x = b[i] * stage.v;
        change.v = b[i] * a;
      } else {
        change.x += b[i] * stage.v;
        change.v += b[i] * a;
      }
      if (i == 3) break;
      stage.x = y.x + c[i + 1] * tau * stage.v;
      stage.v = y.v + c[i + 1] * tau * a;
    }
    y.x += tau * change.x;
    y.v += tau * change.v;
  }
};

Rk4 rk4_in(Scratch& scratch) {
  scratch.rates.resize(2);
  return {scratch.rates[0], scratch.rates[1], scratch.av};
}

double rk4_step_limit(const SplitOde& ode, double t, const State& y) { return rk4_limit(spectrum(ode, t, y)); }

/// Modes outside the limit do not alternate, so that only stretching is watched for.
bool whole_rk4_step(Step& s, double substeps) {
  const Rk4 step = rk4_in(s.scratch);
  const double tau = s.h / substeps;
  s.error.constant = std::pow(substeps, -4) / 120;
  s.y1() = s.y0();
  for (double k = 0; k < substeps; ++k) {
    step(s.ode, s.t + k * tau, tau, s.y1());
    s.pass(s.t + (k + 1) * tau, s.y1());
    if (limit_narrowed(s, rk4_step_limit, s.t + (k + 1) * tau, s.y1().v, false)) return false;
  }
  return true;
}

}  // namespace

// Y1 = y0,   Y2 = y0 + h/2 F1,   Y3 = y0 + h/2 F2,   Y4 = y0 + h F3,   y1 = y0 + h/6 (F1 + 2 F2 + 2 F3 + F4)
// with F = (v, M⁻¹ f)   [Kutta 1901]
void rk4(Step& s) {
  s.y1() = s.y0();
  rk4_in(s.scratch)(s.ode, s.t, s.h, s.y1());
  s.error.constant = 1.0 / 120;
}

// The same in equal sub-steps inside the stability limit.
void rk4_substeps(Step& s) { sub_step(s, rk4_step_limit, whole_rk4_step); }

}  // namespace drape::solver
