#pragma once

#include "reference/first_order.hpp"
#include "reference/sundials.hpp"
#include "reference/trajectory.hpp"

namespace drape::reference::sundials_tools {

/// A first-order ODE as CVODE and ARKODE call it: the user data of their callbacks.
struct FirstOrderProblem {
  const FirstOrderOde& ode;
  Session& session;

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
};

/// Fills the absolute tolerances of (x, v).
inline void set_absolute_tolerances(N_Vector atol, double duration, const SolveOptions& options) {
  const auto n = N_VGetLength(atol) / 2;
  values(atol).head(n).setConstant(options.rtol * options.size);
  values(atol).tail(n).setConstant(options.rtol * options.size / duration);
}

}  // namespace drape::reference::sundials_tools
