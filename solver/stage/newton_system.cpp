#include "solver/stage/newton_system.hpp"

#include "solver/linear/choose.hpp"

namespace drape::solver {
namespace {

bool factors(const LinearSolver& solver, int particles) {
  switch (solver.newton) {
    case LinearSolver::Newton::factored: return true;
    case LinearSolver::Newton::iterative: return false;
    case LinearSolver::Newton::by_size: break;
  }
  return particles <= LinearChoice::most_factored_newton;
}

}  // namespace

NewtonSystem::NewtonSystem(const SplitOde& ode, const Options& options, StageSystem& system, Jacobian part)
    : ode_(ode),
      options_(options),
      system_(system),
      part_(part),
      factors_(factors(*options.linear_solver, ode.particles())),
      factor_(*ode.work) {}

Outcome NewtonSystem::renew(const Stage& stage, const State& y) {
  gamma_ = 0;
  inertia_ = stage.inertia;
  ode_.newton_matrix(stage.t, y.x, y.v, stage.gamma, part_, J_);
  if (inertia_ != 1)
    for (Eigen::Index i = 0; i < J_.rows(); ++i) J_.coeffRef(i, i) += (inertia_ - 1) * ode_.mass[i / 3];
  Outcome outcome = Outcome::success;
  if (factors_) {
    outcome = factor_.factor(J_);
  } else {
    if (!gradients_) gradients_.emplace(ode_, options_, system_);
    gradients_->prepare(J_);
  }
  if (outcome == Outcome::success) gamma_ = stage.gamma;
  return outcome;
}

LinearResult NewtonSystem::solve(const Vectors& r, Vectors& d) {
  if (gradients_) return gradients_->solve(J_, gamma_, inertia_, r, d);
  factor_.solve(r, d);
  return {};
}

}  // namespace drape::solver
