#pragma once

#include <utility>

#include "solver/methods/acceleration.hpp"

namespace drape::solver {

/// Stabilised explicit Runge-Kutta methods with a given number of stages.
void rkl2(Step& s, double stages);
void rkc2(Step& s, double stages);

/// Number of stages of this step for h times the largest decay; 0 if it is not finite, or above the `most` with which a step
/// would take minutes: then the outcome is set.
double stages_of(Step& s, double (*fewest)(double h_decay), double most = 1e7);

/// Coefficients of a stage Y_j.
struct StageWeights {
  double mu, nu, mu_tilde, gamma_tilde;
};

/// Y_j = (1 − μ − ν) Y_0 + μ Y_{j−1} + ν Y_{j−2} + μ̃ h F_{j−1} + γ̃ h F_0,   Y_1 = Y_0 + μ̃ h F_0,   y1 = Y_s,   with F = (v, M⁻¹
/// f). `weights` gives those of j = 1, 2, … in turn. Returns c of y1, which approximates y(t + c h).
template <class Weights>
double three_term_recurrence(Step& s, double stages, Weights weights) {
  const State& y0 = s.y0();
  s.scratch.rates.resize(2);
  State *before = &s.scratch.rates[0], *last = &s.scratch.rates[1];
  Vectors &a0 = s.scratch.av, &a = s.scratch.f_hat;
  acceleration(s.ode, s.t, y0, a0);
  *before = y0;
  double mu_tilde = weights.next().mu_tilde, c_before = 0, c = mu_tilde;
  last->x = y0.x + mu_tilde * s.h * y0.v;
  last->v = y0.v + mu_tilde * s.h * a0;
  for (double j = 2; j <= stages; ++j) {
    const StageWeights w = weights.next();
    const double rest = 1 - w.mu - w.nu;
    acceleration(s.ode, s.t + c * s.h, *last, a);
    before->x = rest * y0.x + w.mu * last->x + w.nu * before->x + w.mu_tilde * s.h * last->v + w.gamma_tilde * s.h * y0.v;
    before->v = rest * y0.v + w.mu * last->v + w.nu * before->v + w.mu_tilde * s.h * a + w.gamma_tilde * s.h * a0;
    c_before = w.mu * c + w.nu * c_before + w.mu_tilde + w.gamma_tilde;
    std::swap(c, c_before);
    std::swap(last, before);
  }
  s.y1() = *last;
  return c;
}

}  // namespace drape::solver
