#pragma once

#include "reference/first_order.hpp"
#include "reference/reduced_newton.hpp"
#include "reference/sundials.hpp"
#include "reference/trajectory.hpp"

namespace drape::reference::sundials_tools {

/// A first-order ODE as CVODE and ARKODE call it: the user data of their callbacks.
struct FirstOrderProblem {
  const FirstOrderOde& ode;
  Session& session;
  std::optional<ReducedNewton> reduced = {};

  template <Part part>
  static int derivative(realtype t, N_Vector y, N_Vector dy, void* self) {
    const auto& problem = *static_cast<FirstOrderProblem*>(self);
    return problem.session.guarded([&] { problem.ode.derivative(t, values(y), values(dy), part); });
  }

  template <Part part>
  static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector, N_Vector) {
    const auto& problem = *static_cast<FirstOrderProblem*>(self);
    return problem.session.guarded([&] { problem.session.copy(problem.ode.jacobian(t, values(y), part), J); });
  }

  static int prepare(realtype t, N_Vector y, N_Vector, booleantype, booleantype* is_new, realtype gamma, void* self) {
    auto& problem = *static_cast<FirstOrderProblem*>(self);
    *is_new = SUNTRUE;  // assembling takes a small part of factoring
    return problem.session.guarded([&] { return problem.reduced->prepare(t, problem.ode.state(t, values(y)), gamma); });
  }

  static int precondition(realtype t, N_Vector y, N_Vector, N_Vector r, N_Vector z, realtype, realtype, int, void* self) {
    auto& problem = *static_cast<FirstOrderProblem*>(self);
    return problem.session.guarded([&] { problem.solve_reduced(t, values(y), values(r), values(z)); });
  }

  /// z with (I - γ ∂g/∂y) z ≈ r.
  void solve_reduced(double t, const Eigen::Ref<const Eigen::VectorXd>& y, const Eigen::Ref<const Eigen::VectorXd>& r,
                     Eigen::Ref<Eigen::VectorXd> z) {
    const auto n = r.size() / 2;
    const double gamma = reduced->gamma();
    const solver::Vectors p = ode.spread(r.head(n)), still = solver::Vectors::Zero(p.rows(), 3);
    solver::Vectors b = gamma * reduced->derivative(t, ode.state(t, y), {p, still});
    b += ode.ode().mass.asDiagonal() * ode.spread(r.tail(n));
    ode.gather(reduced->solve(std::move(b)), z.tail(n));
    z.head(n) = r.head(n) + gamma * z.tail(n);
  }
};

/// Fills the absolute tolerances of (x, v).
inline void set_absolute_tolerances(N_Vector atol, double duration, const SolveOptions& options) {
  const auto n = N_VGetLength(atol) / 2;
  values(atol).head(n).setConstant(options.rtol * options.size);
  values(atol).tail(n).setConstant(options.rtol * options.size / duration);
}

}  // namespace drape::reference::sundials_tools
