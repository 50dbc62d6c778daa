#include "solver/step.hpp"

namespace drape::solver {
namespace {

constexpr double af = 0.75;  ///< αf for ρ∞ = 1/3, where αm = 1

/// The rates of v, and below them those of x, at the start of the motion.
void start_rates(Step& s) {
  const Eigen::Index n = s.ode.particles();
  s.ode.force(s.t, s.y0().x, s.y0().v, s.scratch.f_hat);
  filter(s.ode.pins, s.scratch.f_hat);
  s.now().f.resize(2 * n, 3);
  for (int c = 0; c < 3; ++c) s.now().f.col(c).head(n) = s.scratch.f_hat.col(c).cwiseQuotient(s.ode.mass);
  s.now().f.bottomRows(n) = s.y0().v;
}

}  // namespace

// The generalised α-method for y' = F in the form of Jansen, Whiting and Hulbert (2000) with ρ∞ = 1/3: with the kept rate r0
//   ys = y0 + αf h ((1 − γ) r0 + γ r1),   r1 = F(t0 + αf h, ys),   y1 = y0 + h ((1 − γ) r0 + γ r1)
// r1 is the rate at t1 − (1 − αf) h; γ is such that y1 is of second order when the step before had another size.
void gen_alpha(Step& s) {
  const Eigen::Index n = s.ode.particles();
  const bool begins = !s.now().has_f;
  if (begins) start_rates(s);
  const double h = s.h, offset = begins || s.w() == 0 ? 0 : -(1 - af) * h / s.w();
  const double gamma = (h / 2 - offset) / (af * h - offset);
  const Vectors& r0 = s.now().f;
  s.scratch.ax = s.y0().x + af * h * (1 - gamma) * r0.bottomRows(n);
  s.scratch.av = s.y0().v + af * h * (1 - gamma) * r0.topRows(n);
  if (!s.solve({af * h * gamma, s.t + af * h, s.scratch.ax, s.scratch.av}, 1.0 / 12)) return;
  State& y = s.y1();
  Vectors& r1 = s.next.f;
  r1.resize(2 * n, 3);
  r1.topRows(n) = (y.v - s.scratch.av) / (af * h * gamma);
  r1.bottomRows(n) = y.v;
  y.x = s.y0().x + h * ((1 - gamma) * r0.bottomRows(n) + gamma * r1.bottomRows(n));
  y.v = s.y0().v + h * ((1 - gamma) * r0.topRows(n) + gamma * r1.topRows(n));
  s.next.has_f = true;
}

}  // namespace drape::solver
