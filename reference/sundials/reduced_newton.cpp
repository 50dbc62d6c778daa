#include "reference/sundials/reduced_newton.hpp"

#include <cmath>

#include "solver/linear/choose.hpp"
#include "solver/linear/kernels.hpp"

namespace drape::reference {

using solver::State;
using solver::Vectors;

namespace {

/// Tolerance of the system with the constant matrix where partial pins make its factor a preconditioner.
constexpr double accuracy = 1e-8;

/// Options of the constant matrix: a factor up to sizes where `auto` of our own methods iterates. Theirs are loose solves; here
/// each is to `accuracy`, which takes multigrid several cycles, and a factor one substitution.
solver::Options constant_options(int particles) {
  solver::Options options;
  if (particles <= solver::LinearChoice::most_factored_without_grid) options.linear_solver = &solver::linear_solver("cholesky");
  return options;
}

/// Size of the difference quotient relative to the state.
constexpr double difference = 1e-7;

}  // namespace

ReducedNewton::ReducedNewton(const solver::SplitOde& ode, NewtonSolve::Matrix matrix, double kept)
    : ode_(ode), kept_(kept), dv_(Vectors::Zero(ode.particles(), 3)) {
  if (matrix == NewtonSolve::Matrix::constant)
    constant_.emplace(ode, constant_options(ode.particles()), nullptr);
  else
    factor_.emplace(*ode.work);
}

bool ReducedNewton::prepare(double t, const State& y, double gamma) {
  gamma_ = gamma;
  if (constant_) return constant_->prepare(gamma, 1, kept_) == solver::Outcome::success;
  ode_.newton_matrix(t, y.x, y.v, gamma, solver::Jacobian::whole, matrix_);
  return factor_->factor(matrix_) == solver::Outcome::success;
}

void ReducedNewton::multiply(const Vectors& dx, const Vectors* dv, Vectors& df) {
  solver::multiply(ode_.stiffness, dx, df);
  if (dv == nullptr || ode_.damping.nonZeros() == 0) return;
  solver::multiply(ode_.damping, *dv, dv_);
  df += dv_;
}

double ReducedNewton::move(const State& y, const Vectors& dx, const Vectors* dv) {
  const double scale = std::hypot(y.x.norm(), y.v.norm()), size = std::hypot(dx.norm(), dv == nullptr ? 0 : dv->norm());
  if (!(size > 1e-16 * scale)) return 0;
  const double part = difference * scale / size;
  moved_.x = y.x + part * dx;
  moved_.v = y.v;
  if (dv != nullptr) moved_.v += part * *dv;
  return part;
}

const Vectors& ReducedNewton::solve(Vectors& b) {
  solver::filter(ode_.pins, b);
  if (constant_) {
    constant_->respond(b, accuracy);
    return constant_->correction();
  }
  factor_->solve(b, dv_);
  return dv_;
}

}  // namespace drape::reference
