#include "reference/cvode.hpp"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <type_traits>

#include "reference/first_order.hpp"

namespace drape::reference {
namespace {

struct Destroy {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
  void operator()(void* cvode) const { CVodeFree(&cvode); }
  void operator()(char* text) const { std::free(text); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy>;

template <class Handle>
Owned<Handle> own(Handle created) {
  if (!created) throw std::bad_alloc();  // the sizes and types are right, so nothing else can have failed
  return Owned<Handle>(created);
}

auto values(N_Vector vector) { return Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(vector), N_VGetLength(vector)); }

/// One integration from t0 to the end. CVODE keeps the address of this object.
class Integrator {
 public:
  Integrator(const FirstOrderOde& ode, solver::Work& work, double t0, double end, const CvodeOptions& options);
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// y at time t, which must not be before the last one asked for.
  Eigen::VectorXd advance(double t);

  void count_work(solver::Work& work) const;

 private:
  static int derivative(realtype t, N_Vector y, N_Vector dy, void* self);
  static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector, N_Vector);
  static void on_error(int code, const char*, const char*, char* message, void* self);

  /// Runs a callback: exceptions must not pass through C code, they become its "unrecoverable" and the reason to report.
  template <class Function>
  int guarded(Function&& function) noexcept;
  void copy(const WideSparseMatrix& from, SUNMatrix to);
  void require(int flag, char* (*flag_name)(long) = CVodeGetReturnFlagName) const;

  const FirstOrderOde& ode_;
  std::int64_t& analyses_;
  std::string reason_;
  WideSparseMatrix pattern_;  ///< the Jacobian that KLU has analysed; only its pattern is used

  sundials::Context context_;  // before all that is made in it
  Owned<N_Vector> y_;
  Owned<SUNMatrix> matrix_;
  Owned<SUNLinearSolver> klu_;
  Owned<void*> cvode_;
};

Integrator::Integrator(const FirstOrderOde& ode, solver::Work& work, double t0, double end, const CvodeOptions& options)
    : ode_(ode),
      analyses_(work.counter("cvode/analyses", "symbolic analyses of the sparse Newton matrix by KLU")),
      y_(own(N_VNew_Serial(ode.size(), context_))),
      matrix_(own(SUNSparseMatrix(ode.size(), ode.size(), ode.size(), CSR_MAT, context_))),
      klu_(own(SUNLinSol_KLU(y_.get(), matrix_.get(), context_))),
      cvode_(own(CVodeCreate(CV_BDF, context_))) {
  const auto atol = own(N_VNew_Serial(ode.size(), context_));
  values(atol.get()).head(ode.size() / 2).setConstant(options.rtol * options.size);
  values(atol.get()).tail(ode.size() / 2).setConstant(options.rtol * options.size / (end - t0));
  values(y_.get()) = ode.initial();

  require(CVodeSetErrHandlerFn(cvode_.get(), on_error, this));
  require(CVodeInit(cvode_.get(), derivative, t0, y_.get()));
  require(CVodeSetUserData(cvode_.get(), this));
  require(CVodeSVtolerances(cvode_.get(), options.rtol, atol.get()));
  require(CVodeSetMaxNumSteps(cvode_.get(), options.max_steps));
  require(CVodeSetStabLimDet(cvode_.get(), SUNTRUE));  // orders 3 to 5 are not A-stable
  require(CVodeSetStopTime(cvode_.get(), end));
  require(CVodeSetLinearSolver(cvode_.get(), klu_.get(), matrix_.get()), CVodeGetLinReturnFlagName);
  require(CVodeSetJacFn(cvode_.get(), jacobian), CVodeGetLinReturnFlagName);
}

Eigen::VectorXd Integrator::advance(double t) {
  double reached;
  require(CVode(cvode_.get(), t, y_.get(), &reached, CV_NORMAL));
  return values(y_.get());
}

void Integrator::count_work(solver::Work& work) const {
  const auto add = [&](int (*get)(void*, long*), const char* name, const char* description) {
    long count = 0;
    require(get(cvode_.get(), &count));
    work.counter(name, description) += count;
  };
  add(CVodeGetNumSteps, "cvode/steps", "steps of CVODE");
  add(CVodeGetNumJacEvals, "cvode/jacobians", "Jacobians evaluated by CVODE");
  add(CVodeGetNumLinSolvSetups, "cvode/factorisations", "factorisations of the sparse Newton matrix by KLU");
  add(CVodeGetNumStabLimOrderReds, "cvode/order_reductions", "reductions of the order by stability limit detection");
}

int Integrator::derivative(realtype t, N_Vector y, N_Vector dy, void* self) {
  auto& integrator = *static_cast<Integrator*>(self);
  return integrator.guarded([&] { integrator.ode_.derivative(t, values(y), values(dy)); });
}

int Integrator::jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector, N_Vector) {
  auto& integrator = *static_cast<Integrator*>(self);
  return integrator.guarded([&] { integrator.copy(integrator.ode_.jacobian(t, values(y)), J); });
}

void Integrator::on_error(int code, const char*, const char*, char* message, void* self) {
  auto& reason = static_cast<Integrator*>(self)->reason_;
  if (code < 0 && reason.empty()) reason = message;  // what a callback said is nearer to the cause
}

template <class Function>
int Integrator::guarded(Function&& function) noexcept {
  try {
    function();
    return 0;
  } catch (const std::exception& error) {
    reason_ = error.what();
  } catch (...) {
    reason_ = "the force or its Jacobian threw something that is no std::exception";
  }
  return -1;
}

void Integrator::copy(const WideSparseMatrix& from, SUNMatrix to) {
  const auto n = from.rows(), entries = from.nonZeros();
  const bool known = pattern_.nonZeros() == entries &&
                     std::equal(from.outerIndexPtr(), from.outerIndexPtr() + n + 1, pattern_.outerIndexPtr()) &&
                     std::equal(from.innerIndexPtr(), from.innerIndexPtr() + entries, pattern_.innerIndexPtr());
  if (!known) {
    if (SUNSparseMatrix_Reallocate(to, entries) != 0) throw std::bad_alloc();
    SUNLinSol_KLUReInit(klu_.get(), to, entries, SUNKLU_REINIT_PARTIAL);
    ++analyses_;
    pattern_ = from;
  }
  // CVODE has cleared the indices, too.
  std::copy_n(from.outerIndexPtr(), n + 1, SUNSparseMatrix_IndexPointers(to));
  std::copy_n(from.innerIndexPtr(), entries, SUNSparseMatrix_IndexValues(to));
  std::copy_n(from.valuePtr(), entries, SUNSparseMatrix_Data(to));
}

void Integrator::require(int flag, char* (*flag_name)(long)) const {
  if (flag >= 0) return;
  double reached = 0;
  CVodeGetCurrentTime(cvode_.get(), &reached);
  const Owned<char*> name(flag_name(flag));
  throw ReferenceError(fmt::format("CVODE stopped at t = {} s with {}: {}", reached, name.get(), reason_), name.get(), reached);
}

void check(std::span<const double> times, double t0, const CvodeOptions& options) {
  if (times.empty() || times.front() < t0 || times.back() <= t0 ||
      std::ranges::adjacent_find(times, std::greater_equal()) != times.end())
    throw std::invalid_argument(fmt::format("output times must increase, start at t0 = {} s or later and end after it", t0));
  if (!(options.rtol > 0) || !(options.size > 0))
    throw std::invalid_argument(fmt::format("rtol = {} and size = {} m must both be positive", options.rtol, options.size));
}

}  // namespace

Trajectory cvode(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                 const CvodeOptions& options) {
  check(times, t0, options);
  const FirstOrderOde first_order(ode, y0, t0);
  Integrator integrator(first_order, *ode.work, t0, times.back(), options);
  Trajectory trajectory{{times.begin(), times.end()}, {}};
  for (double t : times)  // CVODE does not take a first output time that is no step away
    trajectory.states.push_back(first_order.state(t, t == t0 ? first_order.initial() : integrator.advance(t)));
  integrator.count_work(*ode.work);
  return trajectory;
}

}  // namespace drape::reference
