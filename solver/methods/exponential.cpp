#include <initializer_list>

#include "solver/methods/acceleration.hpp"

namespace drape::solver {
namespace {

/// Error left in functions of the Jacobian over the size of h F. Once a space converges, two or three dimensions gain a digit,
/// so that less accuracy would save few products.
constexpr double krylov_accuracy = 1e-10;

/// Takes the Jacobian at the start and sets b_1 = h F and b_2 = h² ∂F/∂t; ax = h a and f̂ = h² ∂a/∂t stay for `remainder`.
bool linearise_motion(Step& s, State& b) {
  s.result.outcome = s.phi->linearise(s.h, s.t, s.y0());
  if (s.result.outcome != Outcome::success) return false;
  acceleration(s.ode, s.t, s.y0(), s.scratch.ax);
  s.scratch.ax *= s.h;
  b.x = s.h * s.y0().v;
  b.v = s.scratch.ax;
  s.phi->set_input(1, b);
  find_time_derivative(s);
  b.x.setZero();
  b.v = s.scratch.f_hat;
  s.phi->set_input(2, b);
  return true;
}

bool evaluate(Step& s, int parts, std::initializer_list<PhiFunctions::Output> outputs, double error) {
  s.result.outcome = s.phi->evaluate(parts, {outputs.begin(), outputs.size()}, error);
  return s.result.outcome == Outcome::success;
}

/// y1 = y0 + u.
void add_to_start(Step& s, const State& u) {
  s.y1().x = s.y0().x + u.x;
  s.y1().v = s.y0().v + u.v;
}

/// R = h a(t0 + c h, y0 + u) less its linearisation: h times the nonlinear remainder of the accelerations. That of dx/dt is 0.
/// `Ju` is overwritten, and y1.
void remainder(Step& s, double c, const State& u, State& Ju, Vectors& R) {
  s.phi->multiply(u, Ju);
  add_to_start(s, u);
  acceleration(s.ode, s.t + c * s.h, s.y1(), R);
  R = s.h * R - s.scratch.ax - Ju.v - c * s.scratch.f_hat;
}

/// b_p = (0, b).
template <class Field>
void set_input(Step& s, int p, const Field& b, State& memory) {
  memory.x.setZero();
  memory.v = b;
  s.phi->set_input(p, memory);
}

}  // namespace

// y1 = y0 + h φ_1(hJ) F + h² φ_2(hJ) ∂F/∂t   [Pope 1963; Hochbruck, Ostermann 2010], with F = (v, M⁻¹ f) and its exact Jacobian
// J. The estimate of the error is what the method exprb32 adds, of third order: 2 h φ_3(hJ) R(y1)   [Hochbruck et al. 2009].
void exponential_euler(Step& s) {
  s.scratch.rates.resize(2);
  State &u = s.scratch.rates[0], &b = s.scratch.rates[1];
  if (!linearise_motion(s, b)) return;
  const double error = krylov_accuracy * s.phi->size(1);
  if (!evaluate(s, 1, {{1, &u}}, error)) return;
  if (s.options.error_control.enabled()) {
    remainder(s, 1, u, b, s.scratch.av);
    set_input(s, 3, 2 * s.scratch.av, b);
    s.error.embedded = true;
    if (!evaluate(s, 1, {{1, &s.error.estimate}}, error)) return;
  }
  add_to_start(s, u);
}

// With w(c) = c h φ_1(c hJ) F + (c h)² φ_2(c hJ) ∂F/∂t, which one space gives for all c:
//   U_2 = y0 + w(1/2),   U_3 = y0 + w(2/3),
//   y1 = y0 + w(1) + h φ_3(hJ) (32 R(U_2) − 27/2 R(U_3)) + h φ_4(hJ) (−144 R(U_2) + 81 R(U_3))   [Rainwater, Tokman 2016]
// Without the last term it is of third order: that term estimates the error.
void epirk4s3a(Step& s) {
  s.scratch.rates.resize(4);
  State &u2 = s.scratch.rates[0], &u3 = s.scratch.rates[1], &u = s.scratch.rates[2], &b = s.scratch.rates[3];
  if (!linearise_motion(s, b)) return;
  const double error = krylov_accuracy * s.phi->size(1);
  if (!evaluate(s, 6, {{3, &u2}, {4, &u3}, {6, &u}}, error)) return;
  Vectors &R2 = s.scratch.av, &R3 = u2.v;
  remainder(s, 1.0 / 2, u2, b, R2);
  remainder(s, 2.0 / 3, u3, b, R3);
  if (s.options.error_control.enabled()) {
    set_input(s, 4, 81 * R3 - 144 * R2, b);
    s.error.embedded = true;
    if (!evaluate(s, 1, {{1, &s.error.estimate}}, error)) return;
  }
  set_input(s, 3, 32 * R2 - 13.5 * R3, b);
  set_input(s, 4, 81 * R3 - 144 * R2, b);
  if (!evaluate(s, 1, {{1, &u3}}, error)) return;
  u.x += u3.x;
  u.v += u3.v;
  add_to_start(s, u);
}

}  // namespace drape::solver
