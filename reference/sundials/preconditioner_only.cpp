#include "reference/sundials/preconditioner_only.hpp"

#include <new>

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

}  // namespace

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

}  // namespace drape::reference::sundials_tools
