#include "reference/sundials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "reference/preconditioner_only.hpp"
#include "reference/trajectory.hpp"

namespace drape::reference::sundials_tools {
namespace {

constexpr int krylov_dimension = 10;  ///< of GMRES

SUNLinearSolver make_linear_solver(const NewtonSolve& newton, N_Vector y, SUNMatrix matrix, SUNContext context) {
  if (newton.gmres) return SUNLinSol_SPGMR(y, SUN_PREC_LEFT, krylov_dimension, context);
  if (newton.reduced()) return make_preconditioner_only(context);
  return SUNLinSol_KLU(y, matrix, context);
}

}  // namespace

Session::Session(std::string_view solver, std::string_view prefix, std::int64_t size, solver::Work& work,
                 const NewtonSolve& newton)
    : solver_(solver),
      analyses_(work.counter(fmt::format("{}/analyses", prefix), "symbolic analyses of the sparse Newton matrix by KLU")),
      y_(require_created(N_VNew_Serial(size, context_))),
      matrix_(newton.reduced() ? nullptr : require_created(SUNSparseMatrix(size, size, size, CSR_MAT, context_))),
      linear_solver_(require_created(make_linear_solver(newton, y_.get(), matrix_.get(), context_))) {}

void Session::copy(const WideSparseMatrix& from, SUNMatrix to) {
  const auto n = from.rows(), entries = from.nonZeros();
  const bool known = pattern_.nonZeros() == entries &&
                     std::equal(from.outerIndexPtr(), from.outerIndexPtr() + n + 1, pattern_.outerIndexPtr()) &&
                     std::equal(from.innerIndexPtr(), from.innerIndexPtr() + entries, pattern_.innerIndexPtr());
  if (!known) {
    if (SUNSparseMatrix_Reallocate(to, entries) != 0) throw std::bad_alloc();
    SUNLinSol_KLUReInit(linear_solver_.get(), to, entries, SUNKLU_REINIT_PARTIAL);
    ++analyses_;
    pattern_ = from;
  }
  std::copy_n(from.outerIndexPtr(), n + 1, SUNSparseMatrix_IndexPointers(to));
  std::copy_n(from.innerIndexPtr(), entries, SUNSparseMatrix_IndexValues(to));
  std::copy_n(from.valuePtr(), entries, SUNSparseMatrix_Data(to));
}

void Session::require(int flag, FlagName flag_name, double reached) const {
  if (flag >= 0) return;
  const std::unique_ptr<char, void (*)(void*)> name(flag_name(flag), std::free);
  throw ReferenceError(fmt::format("{} stopped at t = {} s with {}: {}", solver_, reached, name.get(), reason_), name.get(),
                       reached);
}

void Session::on_error(int code, const char*, const char*, char* message, void* self) {
  auto& reason = static_cast<Session*>(self)->reason_;
  if (code < 0 && reason.empty()) reason = message;  // what a callback said is nearer to the cause
}

void add_counts(std::initializer_list<SolverCount> counts, void* memory, solver::Work& work) {
  for (const auto& [get, name, description] : counts) {
    long count = 0;
    get(memory, &count);
    work.counter(name, description) += count;
  }
}

}  // namespace drape::reference::sundials_tools
