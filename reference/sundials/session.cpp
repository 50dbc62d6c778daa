#include "reference/sundials/session.hpp"

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_spgmr.h>

#include <cstdlib>

#include "reference/sundials/preconditioner_only.hpp"
#include "reference/trajectory.hpp"

namespace drape::reference::sundials_tools {
namespace {

constexpr int krylov_dimension = 10;  ///< of GMRES

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
