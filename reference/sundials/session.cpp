#include "reference/sundials/session.hpp"

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_spgmr.h>

#include <cstdlib>
#include <new>

#include "reference/trajectory.hpp"

namespace drape::reference::sundials_tools {
namespace {

/// What the integrator gives us to call.
struct Calls {
  void* data = nullptr;
  SUNPSetupFn setup = nullptr;
  SUNPSolveFn solve = nullptr;
};

Calls& calls(SUNLinearSolver solver) { return *static_cast<Calls*>(solver->content); }

int keep_preconditioner(SUNLinearSolver solver, void* data, SUNPSetupFn setup, SUNPSolveFn solve) {
  calls(solver) = {data, setup, solve};
  return SUNLS_SUCCESS;
}

int set_up(SUNLinearSolver solver, SUNMatrix) {
  const int flag = calls(solver).setup(calls(solver).data);
  return flag == 0 ? SUNLS_SUCCESS : flag < 0 ? SUNLS_PSET_FAIL_UNREC : SUNLS_PSET_FAIL_REC;
}

int apply(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, realtype tolerance) {
  constexpr int left = 1;
  const int flag = calls(solver).solve(calls(solver).data, b, x, tolerance, left);
  return flag == 0 ? SUNLS_SUCCESS : flag < 0 ? SUNLS_PSOLVE_FAIL_UNREC : SUNLS_PSOLVE_FAIL_REC;
}

int destroy(SUNLinearSolver solver) {
  delete &calls(solver);
  SUNLinSolFreeEmpty(solver);
  return SUNLS_SUCCESS;
}

constexpr int krylov_dimension = 10;  ///< of GMRES

/// A linear solver of SUNDIALS that applies the user's preconditioner once: for one that is nearly the inverse. SUNDIALS keeps
/// it up to date by the rules it has for preconditioners. Null if there is no memory.
SUNLinearSolver make_preconditioner_only(SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (solver == nullptr) return nullptr;
  solver->content = new Calls;
  _generic_SUNLinearSolver_Ops& ops = *solver->ops;
  ops.gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_ITERATIVE; };
  ops.getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
  ops.setatimes = [](SUNLinearSolver, void*, SUNATimesFn) { return SUNLS_SUCCESS; };
  ops.setpreconditioner = keep_preconditioner;
  ops.initialize = [](SUNLinearSolver) { return SUNLS_SUCCESS; };
  ops.setup = set_up;
  ops.solve = apply;
  ops.numiters = [](SUNLinearSolver) { return 1; };
  ops.resid = [](SUNLinearSolver) -> N_Vector { return nullptr; };  // called only where there were no iterations
  ops.resnorm = [](SUNLinearSolver) { return realtype(0); };
  ops.free = destroy;
  return solver;
}

}  // namespace

Owned<SUNLinearSolver> make_linear_solver(const NewtonSolve& newton, N_Vector y, SUNContext context) {
  return Owned<SUNLinearSolver>(require_created(newton.gmres ? SUNLinSol_SPGMR(y, SUN_PREC_LEFT, krylov_dimension, context)
                                                             : make_preconditioner_only(context)));
}

void Session::require(int flag, FlagName flag_name, double reached) const {
  if (flag >= 0) return;
  const std::unique_ptr<char, void (*)(void*)> name(flag_name(flag), std::free);
  throw ReferenceError(fmt::format("{} stopped at t = {} s with {}: {}", solver_, reached, name.get(), reason_), name.get(),
                       reached);
}

void Session::on_error(int code, const char*, const char*, char* message, void* self) {
  auto& reason = static_cast<Session*>(self)->reason_;
  if (code < 0 && reason.empty()) reason = message;  // the message of a callback is nearer to the cause
}

void add_counts(std::initializer_list<SolverCount> counts, void* memory, solver::Counters& work) {
  for (const auto& [get, name, description] : counts) {
    long count = 0;
    get(memory, &count);
    work.counter(name, description) += count;
  }
}

}  // namespace drape::reference::sundials_tools
