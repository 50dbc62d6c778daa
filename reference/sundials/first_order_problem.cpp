#include "reference/sundials/first_order_problem.hpp"

#include <fmt/format.h>

namespace drape::reference::sundials_tools {

using solver::State;
using solver::Vectors;

FirstOrderNewton::FirstOrderNewton(const FirstOrderOde& ode, Part part, const SolveOptions& options, std::string_view prefix)
    : ode_(ode),
      part_(part),
      jacobians_(ode.ode().work->counter(fmt::format("{}/jacobians", prefix), "exact Jacobians evaluated")),
      right_(Vectors::Zero(ode.ode().particles(), 3)) {
  auto& analyses = ode.ode().work->counter(fmt::format("{}/analyses", prefix), "symbolic analyses of the Newton matrix by KLU");
  if (options.newton->reduced())
    reduced_.emplace(ode.ode(), options.newton->matrix, options.tuning.kept_factor);
  else
    klu_.emplace(analyses);
}

bool FirstOrderNewton::prepare(double t, const State& y, bool known, double gamma) {
  if (reduced_) return reduced_->prepare(t, y, gamma);
  gamma_ = gamma;
  const WideSparseMatrix& J = known ? ode_.known_jacobian() : ode_.jacobian(t, y, part_);
  jacobians_ += known ? 0 : 1;
  matrix_ = J;
  matrix_.coeffs() *= -gamma;
  matrix_.diagonal().array() += 1;
  return klu_->factor(matrix_);
}

void FirstOrderNewton::solve(double t, const State& y, const State& dy, double gamma, const State& r, State& z) {
  if (reduced_) return solve_reduced(t, y, dy, r, z);
  Eigen::VectorXd unknowns = ode_.gather(r);
  klu_->solve(unknowns);
  unknowns *= 2 / (1 + gamma / gamma_);  // as CVODE and ARKODE do for a matrix that was factored for another γ
  z.x.setZero();
  z.v.setZero();
  ode_.scatter(unknowns, z);
  solve_memory(y, gamma, r, z);
}

/// The internal variables follow the positions. What they do to the forces is left out: they are a small part.
void FirstOrderNewton::solve_memory(const State& y, double gamma, const State& r, State& z) {
  if (!ode_.ode().memory || part_ == Part::linear)
    z.z = r.z;
  else
    ode_.ode().memory->respond(gamma, y, r.z, z);
}

void FirstOrderNewton::solve_reduced(double t, const State& y, const State& dy, const State& r, State& z) {
  const double gamma = reduced_->gamma();
  const auto& mass = ode_.ode().mass;
  const auto force = [&] { return mass.asDiagonal() * dy.v; };
  reduced_->derivative(t, y, force, r.x, nullptr, right_);
  right_ = mass.asDiagonal() * r.v + gamma * right_;
  z.v = reduced_->solve(right_);
  z.x = r.x + gamma * z.v;
  solve_memory(y, gamma, r, z);
}

}  // namespace drape::reference::sundials_tools
