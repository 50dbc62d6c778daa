#include "solver/methods/acceleration.hpp"

namespace drape::solver {
namespace {

/// The part of the start in the acceleration, α_m, and in the force, α_f, for equal steps.
struct Alphas {
  double m, f;

  /// Those that multiply the fastest modes by ρ∞ and damp slow ones the least   [Chung, Hulbert 1993].
  static constexpr Alphas of_radius(double rho) { return {(2 * rho - 1) / (rho + 1), rho / (rho + 1)}; }
};

/// Coefficients of a step of 1. The kept acceleration a is that of a time near the point it belongs to.
struct AlphaCoefficients {
  double m, f, gamma, beta;

  /// `before`: the time of the kept a0 after t0; that of a1 is α_m − α_f after t1. For equal steps γ = ½ − α_m + α_f.
  AlphaCoefficients(Alphas alphas, double before) : f(alphas.f) {
    const double span = 1 + alphas.m - alphas.f - before;
    m = alphas.m / span;
    gamma = (0.5 - before) / span;
    beta = (0.5 + gamma) * (0.5 + gamma) / 4;
  }

  /// c in the error c h³ d³y/dt³, as far as slow undamped modes show it: a step changes their ω by −c h² ω³.
  double error() const { return (beta + (f * (1 - f) - m * (1 - m) - gamma * gamma) / 2 + 1.0 / 24) / 2; }
};

/// Sets a at the start of the motion.
void start_acceleration(Step& s) {
  if (s.now().has_f) return;
  acceleration(s.ode, s.t, s.y0(), s.now().f);
  s.now().has_f = true;
}

// x1 = x0 + h v0 + h² ((½ − β) a0 + β a1),   v1 = v0 + h ((1 − γ) a0 + γ a1),
// M (α_m a0 + (1 − α_m) a1) = f(t*, α_f y0 + (1 − α_f) y1),   t* = t0 + (1 − α_f) h   [Chung, Hulbert 1993]
// solved for the state y* of the force, whose x* = ax + ξ v* and M v* = M av + g f(t*, x*, v*) with ξ = h β/γ.
void alpha_step(Step& s, Alphas alphas) {
  start_acceleration(s);
  const double h = s.h, w = s.w() > 0 ? s.w() : 1;  // the first step is as those of its size, though its a0 is that of t0
  const AlphaCoefficients c(alphas, (alphas.m - alphas.f) / w);
  const State& y0 = s.y0();
  const Vectors& a0 = s.now().f;
  const double end = 1 - c.f, xi = h * c.beta / c.gamma, g = h * end * c.gamma / (1 - c.m);
  Vectors &ax = s.scratch.ax, &av = s.scratch.av, &a1 = s.next.f;
  ax = y0.x + (end * h - xi) * y0.v + end * h * h * (0.5 - c.beta / c.gamma) * a0;
  av = y0.v + (end * h * (1 - c.gamma) - g * c.m) * a0;
  if (!s.solve({.gamma = xi, .t = s.t + end * h, .ax = ax, .av = av, .inertia = xi / g}, c.error())) return;
  State& y = s.y1();
  a1 = ((y.v - av) / g - c.m * a0) / (1 - c.m);
  y.x = y0.x + h * y0.v + h * h * ((0.5 - c.beta) * a0 + c.beta * a1);
  y.v = y0.v + h * ((1 - c.gamma) * a0 + c.gamma * a1);
  s.next.has_f = true;
}

}  // namespace

void generalized_alpha(Step& s) { alpha_step(s, Alphas::of_radius(0.8)); }
void generalized_alpha_half(Step& s) { alpha_step(s, Alphas::of_radius(0.5)); }

// The trapezoidal rule, β = ¼ and γ = ½   [Newmark 1959]
void newmark(Step& s) { alpha_step(s, {0, 0}); }

// α = 0.1, so that the fastest modes are multiplied by (1 − α)/(1 + α) = 0.82, about as by `generalized-alpha`, and the two
// differ in what slow modes lose   [Hilber, Hughes, Taylor 1977]
void hht(Step& s) { alpha_step(s, {0, 0.1}); }

}  // namespace drape::solver
