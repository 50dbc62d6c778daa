#include "reference/reduced_newton.hpp"

#include <cmath>

namespace drape::reference {

using solver::State;
using solver::Vectors;

namespace {

/// Of the system with the constant matrix where partial pins make its factor a preconditioner.
constexpr double accuracy = 1e-8;

/// Of the difference quotient, relative to the state.
constexpr double difference = 1e-7;

}  // namespace

ReducedNewton::ReducedNewton(const solver::SplitOde& ode, NewtonSolve::Matrix matrix) : ode_(ode) {
  if (matrix == NewtonSolve::Matrix::constant)
    constant_.emplace(ode, solver::Options(), nullptr);
  else
    factor_.emplace(*ode.work);
}

bool ReducedNewton::prepare(double t, const State& y, double gamma) {
  gamma_ = gamma;
  if (constant_) return constant_->prepare(gamma) == solver::Outcome::success;
  ode_.newton_matrix(t, y.x, y.v, gamma, false, matrix_);
  return factor_->factor(matrix_) == solver::Outcome::success;
}

Vectors ReducedNewton::derivative(double t, const State& y, const State& direction) const {
  if (constant_) {
    Vectors df = ode_.stiffness * direction.x;
    if (ode_.damping.nonZeros() > 0) df += ode_.damping * direction.v;
    return df;
  }
  Vectors df = Vectors::Zero(ode_.particles(), 3), f(ode_.particles(), 3);
  const double scale = std::hypot(y.x.norm(), y.v.norm()), size = std::hypot(direction.x.norm(), direction.v.norm());
  if (!(size > 1e-16 * scale)) return df;
  const double epsilon = difference * scale / size;
  ode_.force(t, y.x + epsilon * direction.x, y.v + epsilon * direction.v, df);
  ode_.force(t, y.x, y.v, f);
  df -= f;
  df /= epsilon;
  return df;
}

Vectors ReducedNewton::solve(Vectors b) {
  solver::filter(ode_.pins, b);
  if (constant_) {
    constant_->respond(b, accuracy);
    return constant_->correction();
  }
  Vectors dv(b.rows(), 3);
  factor_->solve(b, dv);
  return dv;
}

}  // namespace drape::reference
