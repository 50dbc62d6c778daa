#pragma once

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "reference/coordinates.hpp"
#include "reference/newton_solves.hpp"

/// What the solvers of SUNDIALS have in common; for the files of this folder that call them  [Hindmarsh et al. 2005].
namespace drape::reference::sundials_tools {

struct Destroy {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy>;

/// The memory of a solver, which its own function frees.
using Memory = std::unique_ptr<void, void (*)(void*)>;

template <class Handle>
auto require_created(Handle created) {
  if (!created) throw std::bad_alloc();  // the sizes and types are right, so nothing else can have failed
  return created;
}

inline auto values(N_Vector vector) { return Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(vector), N_VGetLength(vector)); }

/// The function of a solver that names its return flags; the name is on the heap.
using FlagName = char* (*)(long);

/// One use of a solver: a vector, a linear solver, and the reason of the first failure. Solvers keep its address.
class Session {
 public:
  /// `solver` is for messages, for example "CVODE". Counts the analyses of KLU in `work` under `prefix`/analyses.
  Session(std::string_view solver, std::string_view prefix, std::int64_t size, solver::Work& work,
          const NewtonSolve& newton = newton_solves().front());
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  SUNContext context() { return context_; }
  N_Vector y() { return y_.get(); }
  SUNMatrix matrix() { return matrix_.get(); }  ///< null unless KLU factors one
  SUNLinearSolver linear_solver() { return linear_solver_.get(); }
  Owned<N_Vector> new_vector() { return Owned<N_Vector>(require_created(N_VClone(y_.get()))); }

  /// Runs a callback: exceptions must not pass through C code, they become its "unrecoverable" and the reason to report. One
  /// that returns false becomes "recoverable": it may be called again after a smaller step.
  template <class Function>
  int guarded(Function&& function) noexcept {
    try {
      if constexpr (std::is_same_v<decltype(function()), bool>)
        return function() ? 0 : 1;
      else
        function();
      return 0;
    } catch (const std::exception& error) {
      reason_ = error.what();
    } catch (...) {
      reason_ = "the force or its Jacobian threw something that is no std::exception";
    }
    return -1;
  }

  /// Fills a matrix of the solver, whose indices it has cleared; has KLU analyse it if its pattern is new.
  void copy(const WideSparseMatrix& from, SUNMatrix to);

  /// Throws ReferenceError for a failure; `reached` is the time so far [s].
  void require(int flag, FlagName flag_name, double reached = 0) const;

  /// The error handler of all solvers; `self` is a Session.
  static void on_error(int code, const char* module, const char* function, char* message, void* self);

 private:
  std::string solver_;
  std::int64_t& analyses_;
  std::string reason_;
  WideSparseMatrix pattern_;  ///< what KLU has analysed; only its pattern is used

  sundials::Context context_;  // before all that is made in it
  Owned<N_Vector> y_;
  Owned<SUNMatrix> matrix_;
  Owned<SUNLinearSolver> linear_solver_;
};

/// A counter of a solver's own, added to ours.
struct SolverCount {
  int (*get)(void*, long*);
  const char* name;
  const char* description;
};
void add_counts(std::initializer_list<SolverCount> counts, void* memory, solver::Work& work);

}  // namespace drape::reference::sundials_tools
