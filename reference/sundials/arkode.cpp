#include "reference/sundials/arkode.hpp"

#include <arkode/arkode_arkstep.h>

#include <algorithm>

#include "reference/sundials/first_order_problem.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;

/// The rest is explicit.
enum class Implicit { everything, linear_part, nothing };

Part implicit_part(Implicit implicit) { return implicit == Implicit::linear_part ? Part::linear : Part::whole; }

/// A table of ARKODE: by its name, or made of our coefficients.
class Table {
 public:
  Table(const Tableau::Part& part, int order, ARKodeButcherTable (*load)(const char*)) {
    if (!part.table.empty()) table_.reset(load(std::string(part.table).c_str()));
    if (!part.b.empty()) table_.reset(create(part, order));
  }
  ARKodeButcherTable get() const { return table_.get(); }

 private:
  static ARKodeButcherTable create(Tableau::Part part, int order) {
    const int stages = static_cast<int>(part.b.size());
    return ARKodeButcherTable_Create(stages, order, 0, part.c.data(), part.A.data(), part.b.data(), nullptr);
  }

  std::unique_ptr<ARKodeButcherTableMem, decltype(&ARKodeButcherTable_Free)> table_{nullptr, ARKodeButcherTable_Free};
};

/// One integration from t0 to the end. ARKODE keeps the address of this object.
class Arkode {
 public:
  Arkode(const FirstOrderOde& ode, Implicit implicit, double t0, double end, const SolveOptions& options);

  /// y at time t, which must be after that of the last call. Steps end there: interpolation would cost accuracy.
  const solver::State& advance(double t) {
    require(ARKStepSetStopTime(memory_.get(), t));
    double reached;
    while (require(ARKStepEvolve(memory_.get(), t, y_.get(), &reached, ARK_NORMAL)) == ARK_ROOT_RETURN &&
           !same_time(reached, t))
      restart(reached, t);
    return state(y_.get());
  }

  void count_work(solver::Counters& work) const {
    add_counts({{ARKStepGetNumSteps, "arkode/steps", "steps of ARKODE"},
                {ARKStepGetNumLinSolvSetups, "arkode/factorisations", "factorisations of the Newton matrix"}},
               memory_.get(), work);
  }

 private:
  void set_newton(Implicit implicit, const SolveOptions& options);
  void set_steps(const Tuning& tuning);
  void set_control(const SolveOptions& options);

  /// Behind a kink stages are not predicted from before it.
  void restart(double t, double stop) {
    ++problem_.ode.ode().work->counter("arkode/restarts", "kinks of forces at which ARKODE began again");
    problem_.begin_part(state(y_.get()));
    require(ARKStepReset(memory_.get(), t, y_.get()));
    require(ARKStepSetStopTime(memory_.get(), stop));
  }

  int require(int flag, FlagName flag_name = ARKStepGetReturnFlagName) const {
    double reached = 0;
    ARKStepGetCurrentTime(memory_.get(), &reached);
    session_.require(flag, flag_name, reached);
    return flag;
  }

  Session session_;
  Owned<N_Vector> y_;
  Owned<SUNLinearSolver> linear_solver_;
  FirstOrderProblem problem_;
  Memory memory_;
};

void* create(Implicit implicit, double t0, N_Vector y, SUNContext context) {
  using P = FirstOrderProblem;
  switch (implicit) {
    case Implicit::everything: return ARKStepCreate(nullptr, P::derivative<Part::whole>, t0, y, context);
    case Implicit::nothing: return ARKStepCreate(P::derivative<Part::whole>, nullptr, t0, y, context);
    case Implicit::linear_part: break;
  }
  return ARKStepCreate(P::derivative<Part::remainder>, P::derivative<Part::linear>, t0, y, context);
}

Arkode::Arkode(const FirstOrderOde& ode, Implicit implicit, double t0, double end, const SolveOptions& options)
    : session_("ARKODE"),
      y_(start_vector(ode, session_)),
      problem_{ode, session_},
      memory_(require_created(create(implicit, t0, y_.get(), session_.context())), [](void* memory) { ARKStepFree(&memory); }) {
  const auto atol = absolute_tolerances(y_, end - t0, options);
  void* const arkode = memory_.get();
  require(ARKStepSetErrHandlerFn(arkode, Session::on_error, &session_));
  require(ARKStepSetUserData(arkode, &problem_));
  require(ARKStepSVtolerances(arkode, options.rtol, atol.get()));
  require(ARKStepSetMaxNumSteps(arkode, options.max_steps));
  if (options.tuning.step > 0)
    set_steps(options.tuning);
  else
    set_control(options);
  if (implicit != Implicit::nothing) set_newton(implicit, options);
}

/// Steps that follow the error end at kinks.
void Arkode::set_control(const SolveOptions& options) {
  require(ARKStepSetOrder(memory_.get(), options.max_order));
  require(ARKStepRootInit(memory_.get(), problem_.begin_part(problem_.ode.initial()), FirstOrderProblem::roots));
}

/// Lagrange's interpolant of states predicts stages: Hermite's would need forces at the ends of steps.
void Arkode::set_steps(const Tuning& tuning) {
  const Tableau& method = *tuning.tableau;
  const Table implicit(method.implicit, method.order, ARKodeButcherTable_LoadDIRKByName);
  const Table explicit_part(method.explicit_part, method.order, ARKodeButcherTable_LoadERKByName);
  void* const arkode = memory_.get();
  require(ARKStepSetTables(arkode, method.order, 0, implicit.get(), explicit_part.get()));
  require(ARKStepSetFixedStep(arkode, tuning.step));
  require(ARKStepSetInterpolantType(arkode, ARK_INTERP_LAGRANGE));
  require(ARKStepSetInterpolantDegree(arkode, 2));
}

void Arkode::set_newton(Implicit implicit, const SolveOptions& options) {
  void* const arkode = memory_.get();
  // Without a predictor, or with less iterations, a step needs up to thirty times as many factorisations.
  require(ARKStepSetPredictorMethod(arkode, 1));
  require(ARKStepSetMaxNonlinIters(arkode, std::max(8, options.tuning.max_iterations)));
  if (options.tuning.nonlinear > 0) require(ARKStepSetNonlinConvCoef(arkode, options.tuning.nonlinear));
  if (options.tuning.deduced) require(ARKStepSetDeduceImplicitRhs(arkode, SUNTRUE));
  linear_solver_ = make_linear_solver(*options.newton, y_.get(), session_.context());
  problem_.newton.emplace(problem_.ode, implicit_part(implicit), options, "arkode");
  require(ARKStepSetLinearSolver(arkode, linear_solver_.get(), nullptr), ARKStepGetLinReturnFlagName);
  if (implicit == Implicit::linear_part) require(ARKStepSetLinear(arkode, 0));
  require(ARKStepSetPreconditioner(arkode, FirstOrderProblem::prepare, FirstOrderProblem::precondition),
          ARKStepGetLinReturnFlagName);
}

Trajectory solve(Implicit implicit, const solver::SplitOde& ode, const solver::State& y0, double t0,
                 std::span<const double> times, const SolveOptions& options) {
  check(times, t0, options);
  const FirstOrderOde first_order(ode, y0, t0);
  Arkode solver(first_order, implicit, t0, times.back(), options);
  Trajectory trajectory{{times.begin(), times.end()}, {}};
  for (double t : times)
    trajectory.states.push_back(first_order.output(t, t == t0 ? first_order.initial() : solver.advance(t)));
  solver.count_work(*ode.work);
  return trajectory;
}

}  // namespace

Trajectory arkode_esdirk(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                         const SolveOptions& options) {
  return solve(Implicit::everything, ode, y0, t0, times, options);
}

Trajectory arkode_imex(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                       const SolveOptions& options) {
  return solve(Implicit::linear_part, ode, y0, t0, times, options);
}

Trajectory arkode_erk(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                      const SolveOptions& options) {
  return solve(Implicit::nothing, ode, y0, t0, times, options);
}

Trajectory arkode_steps(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                        const SolveOptions& options) {
  const Tableau& method = *options.tuning.tableau;
  const Implicit implicit = !method.implicit       ? Implicit::nothing
                            : method.explicit_part ? Implicit::linear_part
                                                   : Implicit::everything;
  return solve(implicit, ode, y0, t0, times, options);
}

}  // namespace drape::reference
