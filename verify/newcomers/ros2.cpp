#include <cmath>

#include "solver/step.hpp"

namespace drape::solver {
namespace {

/// (1 − g A) k = r with A of K and D, so (M − g D − g² K) k_v = M r_v + g K r_x and k_x = r_x + g k_v, by conjugate gradients.
bool solve(Step& s, double g, const State& r, State& k) {
  const SplitOde& ode = s.ode;
  Vectors &left = s.scratch.ax, &p = s.scratch.av, &q = s.scratch.f_hat;
  left.noalias() = ode.stiffness * r.x;
  left *= g;
  left += ode.mass.asDiagonal() * r.v;
  filter(ode.pins, left);
  p = left;
  k.v.setZero(ode.particles(), 3);
  double square = left.squaredNorm();
  const double enough = 1e-28 * square;
  for (int n = 0; square > enough; ++n) {
    q.noalias() = ode.stiffness * p;
    q *= -g * g;
    if (ode.damping.nonZeros() > 0) q.noalias() -= g * (ode.damping * p);
    q += ode.mass.asDiagonal() * p;
    filter(ode.pins, q);
    const double curvature = p.cwiseProduct(q).sum();
    if (n == s.options.max_cg_iterations || !(curvature > 0)) {
      s.result.outcome = curvature > 0 ? Outcome::not_converged : Outcome::breakdown;
      return false;
    }
    k.v += square / curvature * p;
    left -= square / curvature * q;
    const double before = square;
    square = left.squaredNorm();
    p = left + square / before * p;
  }
  k.x = r.x + g * k.v;
  return true;
}

/// (v, M⁻¹ f).
void rate(const SplitOde& ode, double t, const State& y, State& r) {
  r.x = y.v;
  r.v.resize(ode.particles(), 3);
  ode.force(t, y.x, y.v, r.v);
  for (int c = 0; c < 3; ++c) r.v.col(c).array() /= ode.mass.array();
  filter(ode.pins, r.v);
}

}  // namespace

// (1 − γ h A) k1 = F(t0, y0),   (1 − γ h A) k2 = F(t1, y0 + h k1) − 2 k1,   y1 = y0 + h (3 k1 + k2)/2 with γ = 1 − √½, of
// second order for any A, here of K and D: the Rosenbrock-W method ROS2   [Verwer et al. 1999]
void ros2(Step& s) {
  static const double gamma = 1 - std::sqrt(0.5);
  s.scratch.rates.resize(3);
  State &k1 = s.scratch.rates[0], &k2 = s.scratch.rates[1], &r = s.scratch.rates[2], &y1 = s.y1();
  rate(s.ode, s.t, s.y0(), r);
  if (!solve(s, gamma * s.h, r, k1)) return;
  y1.x = s.y0().x + s.h * k1.x;
  y1.v = s.y0().v + s.h * k1.v;
  rate(s.ode, s.t + s.h, y1, r);
  r.x -= 2 * k1.x;
  r.v -= 2 * k1.v;
  if (!solve(s, gamma * s.h, r, k2)) return;
  y1.x = s.y0().x + s.h / 2 * (3 * k1.x + k2.x);
  y1.v = s.y0().v + s.h / 2 * (3 * k1.v + k2.v);
}

}  // namespace drape::solver
