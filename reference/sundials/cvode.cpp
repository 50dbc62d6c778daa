#include "reference/sundials/cvode.hpp"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "reference/sundials/first_order_problem.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;

/// One integration from t0 to the end. CVODE keeps the address of this object.
class Cvode {
 public:
  /// `formulas`: CV_BDF with Newton's method, or CV_ADAMS with functional iteration.
  Cvode(const FirstOrderOde& ode, int formulas, double t0, double end, const SolveOptions& options);

  /// y at time t, which must not be before that of the last call.
  const solver::State& advance(double t) {
    double reached;
    while (require(CVode(memory_.get(), t, y_.get(), &reached, CV_NORMAL)) == CV_ROOT_RETURN && !same_time(reached, t))
      restart(reached);
    return state(y_.get());
  }

  void count_work(solver::Counters& work) const {
    add_counts(
        {{CVodeGetNumSteps, "cvode/steps", "steps of CVODE"},
         {CVodeGetNumLinSolvSetups, "cvode/factorisations", "factorisations of the Newton matrix"},
         {CVodeGetNumStabLimOrderReds, "cvode/order_reductions", "reductions of the order by stability limit detection"}},
        memory_.get(), work);
  }

 private:
  void set_newton(const SolveOptions& options);

  /// Behind a kink the formulas begin with the first order: their polynomials do not reach across.
  void restart(double t) {
    solver::Counters& work = *problem_.ode.ode().work;
    count_work(work);  // CVODE counts from zero again
    ++work.counter("cvode/restarts", "kinks of forces at which CVODE began again");
    problem_.begin_part(state(y_.get()));
    require(CVodeReInit(memory_.get(), t, y_.get()));
  }

  int require(int flag, FlagName flag_name = CVodeGetReturnFlagName) const {
    double reached = 0;
    CVodeGetCurrentTime(memory_.get(), &reached);
    session_.require(flag, flag_name, reached);
    return flag;
  }

  Session session_;
  Owned<N_Vector> y_;
  Owned<SUNLinearSolver> linear_solver_;
  Owned<SUNNonlinearSolver> functional_;
  FirstOrderProblem problem_;
  Memory memory_;
};

Cvode::Cvode(const FirstOrderOde& ode, int formulas, double t0, double end, const SolveOptions& options)
    : session_("CVODE"),
      y_(start_vector(ode, session_)),
      problem_{ode, session_},
      memory_(require_created(CVodeCreate(formulas, session_.context())), [](void* memory) { CVodeFree(&memory); }) {
  const auto atol = absolute_tolerances(y_, end - t0, options);
  void* const cvode = memory_.get();
  require(CVodeSetErrHandlerFn(cvode, Session::on_error, &session_));
  require(CVodeInit(cvode, FirstOrderProblem::derivative<Part::whole>, t0, y_.get()));
  require(CVodeSetUserData(cvode, &problem_));
  require(CVodeSVtolerances(cvode, options.rtol, atol.get()));
  require(CVodeSetMaxNumSteps(cvode, options.max_steps));
  require(CVodeSetStopTime(cvode, end));
  require(CVodeSetMaxOrd(cvode, options.max_order));
  require(CVodeRootInit(cvode, problem_.begin_part(ode.initial()), FirstOrderProblem::roots));
  if (options.tuning.nonlinear > 0) require(CVodeSetNonlinConvCoef(cvode, options.tuning.nonlinear));
  if (options.tuning.max_iterations > 0) require(CVodeSetMaxNonlinIters(cvode, options.tuning.max_iterations));
  if (formulas == CV_BDF) {
    set_newton(options);
    return;
  }
  functional_.reset(require_created(SUNNonlinSol_FixedPoint(y_.get(), 0, session_.context())));
  require(CVodeSetNonlinearSolver(cvode, functional_.get()));
}

void Cvode::set_newton(const SolveOptions& options) {
  void* const cvode = memory_.get();
  linear_solver_ = make_linear_solver(*options.newton, y_.get(), session_.context());
  problem_.newton.emplace(problem_.ode, Part::whole, options, "cvode");
  require(CVodeSetStabLimDet(cvode, SUNTRUE));  // orders 3 to 5 are not A-stable
  require(CVodeSetLinearSolver(cvode, linear_solver_.get(), nullptr), CVodeGetLinReturnFlagName);
  require(CVodeSetPreconditioner(cvode, FirstOrderProblem::prepare, FirstOrderProblem::precondition),
          CVodeGetLinReturnFlagName);
}

Trajectory solve(int formulas, const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                 const SolveOptions& options) {
  check(times, t0, options);
  const FirstOrderOde first_order(ode, y0, t0);
  Cvode solver(first_order, formulas, t0, times.back(), options);
  Trajectory trajectory{{times.begin(), times.end()}, {}};
  for (double t : times)  // CVODE does not take a first output time that is less than a step away
    trajectory.states.push_back(first_order.output(t, t == t0 ? first_order.initial() : solver.advance(t)));
  solver.count_work(*ode.work);
  return trajectory;
}

}  // namespace

Trajectory cvode(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                 const SolveOptions& options) {
  return solve(CV_BDF, ode, y0, t0, times, options);
}

Trajectory cvode_adams(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                       const SolveOptions& options) {
  return solve(CV_ADAMS, ode, y0, t0, times, options);
}

}  // namespace drape::reference
