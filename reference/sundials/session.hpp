#pragma once

#include <cvode/cvode.h>
#include <sundials/sundials_context.h>

#include <cmath>
#include <exception>
#include <initializer_list>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "reference/newton_solves.hpp"
#include "reference/sundials/state_vector.hpp"
#include "solver/counters.hpp"

/// What the solvers of SUNDIALS have in common; for the files of this folder that call them  [Hindmarsh et al. 2005].
namespace drape::reference::sundials_tools {

struct Destroy {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
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

inline Owned<N_Vector> clone(const Owned<N_Vector>& vector) { return Owned<N_Vector>(require_created(N_VClone(vector.get()))); }

/// The state in a vector of StateVector.
inline solver::State& state(N_Vector vector) { return content(vector).state; }

/// GMRES; or one application of the preconditioner where that is the inverse, or nearly.
Owned<SUNLinearSolver> make_linear_solver(const NewtonSolve& newton, N_Vector y, SUNContext context);

/// The function of a solver that names its return flags; the name is on the heap.
using FlagName = char* (*)(long);

/// One use of a solver: its context, and the reason of the first failure. Solvers keep its address.
class Session {
 public:
  /// `solver` is for messages, for example "CVODE".
  explicit Session(std::string_view solver) : solver_(solver) {}
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  SUNContext context() { return context_; }

  /// Runs a callback: exceptions must not pass through C code, they become its "unrecoverable" and the reason to report. One
  /// that returns false becomes "recoverable": it may be called again after a smaller step. Once one has thrown, all fail:
  /// CVODE's functional iteration takes any failure for recoverable and would come ever nearer to where it throws.
  template <class Function>
  int guarded(Function&& function) noexcept {
    if (threw_) return -1;
    try {
      if constexpr (std::is_same_v<decltype(function()), bool>)
        return function() ? 0 : 1;
      else
        function();
      return 0;
    } catch (const std::exception& error) {
      reason_ = error.what();
    } catch (...) {
      reason_ = "the force or its Jacobian threw something that is not a std::exception";
    }
    threw_ = true;
    return -1;
  }

  /// Throws ReferenceError for a failure; `reached` is the time so far [s].
  void require(int flag, FlagName flag_name, double reached = 0) const;

  /// The error handler of all solvers; `self` is a Session.
  static void on_error(int code, const char* module, const char* function, char* message, void* self);

 private:
  std::string solver_, reason_;
  bool threw_ = false;
  sundials::Context context_;
};

/// Whether no step of a solver leads from one to the other [s].
inline bool same_time(double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); }

/// A counter of a solver's own, added to ours.
struct SolverCount {
  int (*get)(void*, long*);
  const char* name;
  const char* description;
};
void add_counts(std::initializer_list<SolverCount> counts, void* memory, solver::Counters& work);

}  // namespace drape::reference::sundials_tools
