#pragma once

#include "reference/sundials/first_order.hpp"
#include "reference/sundials/reduced_newton.hpp"
#include "reference/sundials/session.hpp"
#include "reference/trajectory.hpp"
#include "solver/linear/klu_factor.hpp"

namespace drape::reference::sundials_tools {

/// Solves systems with I - γ ∂g/∂y of a first-order ODE, or with what stands for it.
class FirstOrderNewton {
 public:
  /// `part`: the implicit part. Counts Jacobians and analyses in the ODE's work under `prefix`.
  FirstOrderNewton(const FirstOrderOde& ode, Part part, const SolveOptions& options, std::string_view prefix);

  /// Prepares for a state; with the last Jacobian if it is `known`. False if the matrix is singular.
  bool prepare(double t, const solver::State& y, bool known, double gamma);

  /// z with (I - γ ∂g/∂y) z ≈ r at a state with the derivative dy.
  void solve(double t, const solver::State& y, const solver::State& dy, double gamma, const solver::State& r, solver::State& z);

 private:
  void solve_memory(const solver::State& y, double gamma, const solver::State& r, solver::State& z);
  void solve_reduced(double t, const solver::State& y, const solver::State& dy, const solver::State& r, solver::State& z);

  const FirstOrderOde& ode_;
  Part part_;
  std::optional<ReducedNewton> reduced_;
  std::optional<solver::KluFactor> klu_;  ///< of all unknowns
  WideSparseMatrix matrix_;
  double gamma_ = 0;
  std::int64_t& jacobians_;
  solver::Vectors right_;
};

/// A first-order ODE as CVODE and ARKODE call it: the user data of their callbacks.
struct FirstOrderProblem {
  const FirstOrderOde& ode;
  Session& session;
  std::optional<FirstOrderNewton> newton = {};
  std::vector<int> branches = {}, branches_now = {};  ///< of laws with kinks: of this part of the motion; scratch

  /// A smooth part of the motion begins. Returns the number of roots(): one if forces have kinks.
  int begin_part(const solver::State& y) {
    if (ode.ode().memory) ode.ode().memory->branches(y, branches);
    return branches.empty() ? 0 : 1;
  }

  /// Changes its sign where the first branch of this part ends.
  static int roots(realtype, N_Vector y, realtype* root, void* self) {
    auto& problem = *static_cast<FirstOrderProblem*>(self);
    return problem.session.guarded([&] {
      problem.ode.ode().memory->branches(state(y), problem.branches_now);
      root[0] = problem.branches_now == problem.branches ? 1 : -1;
    });
  }

  template <Part part>
  static int derivative(realtype t, N_Vector y, N_Vector dy, void* self) {
    const auto& problem = *static_cast<FirstOrderProblem*>(self);
    return problem.session.guarded([&] { problem.ode.derivative(t, state(y), state(dy), part); });
  }

  static int prepare(realtype t, N_Vector y, N_Vector, booleantype known, booleantype* is_new, realtype gamma, void* self) {
    auto& problem = *static_cast<FirstOrderProblem*>(self);
    *is_new = !known;
    return problem.session.guarded([&] { return problem.newton->prepare(t, state(y), known, gamma); });
  }

  static int precondition(realtype t, N_Vector y, N_Vector dy, N_Vector r, N_Vector z, realtype gamma, realtype, int,
                          void* self) {
    auto& problem = *static_cast<FirstOrderProblem*>(self);
    return problem.session.guarded([&] { problem.newton->solve(t, state(y), state(dy), gamma, state(r), state(z)); });
  }
};

/// A vector with the start of a first-order ODE.
inline Owned<N_Vector> start_vector(const FirstOrderOde& ode, Session& session) {
  return Owned<N_Vector>(require_created(make_state_vector({ode.initial(), {}, ode.unknowns()}, session.context())));
}

/// The absolute tolerances of (x, v), which other vectors are like.
inline Owned<N_Vector> absolute_tolerances(const Owned<N_Vector>& like, double duration, const SolveOptions& options) {
  Owned<N_Vector> atol = clone(like);
  state(atol.get()).x.setConstant(options.rtol * options.size);
  state(atol.get()).v.setConstant(options.rtol * options.size / duration * options.tuning.velocity_weight);
  state(atol.get()).z.setConstant(options.rtol);
  return atol;
}

}  // namespace drape::reference::sundials_tools
