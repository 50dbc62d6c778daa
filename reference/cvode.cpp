#include "reference/cvode.hpp"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>

#include "reference/first_order_problem.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;

/// One integration from t0 to the end. CVODE keeps the address of this object.
class Cvode {
 public:
  Cvode(const FirstOrderOde& ode, solver::Work& work, double t0, double end, const SolveOptions& options);

  /// y at time t, which must not be before the last one asked for.
  Eigen::VectorXd advance(double t) {
    double reached;
    require(CVode(memory_.get(), t, session_.y(), &reached, CV_NORMAL));
    return values(session_.y());
  }

  void count_work(solver::Work& work) const {
    add_counts(
        {{CVodeGetNumSteps, "cvode/steps", "steps of CVODE"},
         {CVodeGetNumJacEvals, "cvode/jacobians", "Jacobians evaluated by CVODE"},
         {CVodeGetNumLinSolvSetups, "cvode/factorisations", "factorisations of the Newton matrix"},
         {CVodeGetNumStabLimOrderReds, "cvode/order_reductions", "reductions of the order by stability limit detection"}},
        memory_.get(), work);
  }

 private:
  void require(int flag, FlagName flag_name = CVodeGetReturnFlagName) const {
    double reached = 0;
    CVodeGetCurrentTime(memory_.get(), &reached);
    session_.require(flag, flag_name, reached);
  }

  Session session_;
  FirstOrderProblem problem_;
  Memory memory_;
};

Cvode::Cvode(const FirstOrderOde& ode, solver::Work& work, double t0, double end, const SolveOptions& options)
    : session_("CVODE", "cvode", ode.size(), work, *options.newton),
      problem_{ode, session_},
      memory_(require_created(CVodeCreate(CV_BDF, session_.context())), [](void* memory) { CVodeFree(&memory); }) {
  const auto atol = session_.new_vector();
  set_absolute_tolerances(atol.get(), end - t0, options);
  values(session_.y()) = ode.initial();

  void* const cvode = memory_.get();
  require(CVodeSetErrHandlerFn(cvode, Session::on_error, &session_));
  require(CVodeInit(cvode, FirstOrderProblem::derivative<Part::whole>, t0, session_.y()));
  require(CVodeSetUserData(cvode, &problem_));
  require(CVodeSVtolerances(cvode, options.rtol, atol.get()));
  require(CVodeSetMaxNumSteps(cvode, options.max_steps));
  require(CVodeSetStabLimDet(cvode, SUNTRUE));  // orders 3 to 5 are not A-stable
  require(CVodeSetStopTime(cvode, end));
  require(CVodeSetMaxOrd(cvode, options.max_order));
  require(CVodeSetLinearSolver(cvode, session_.linear_solver(), session_.matrix()), CVodeGetLinReturnFlagName);
  if (options.newton->reduced()) {
    problem_.reduced.emplace(ode.ode(), options.newton->matrix);
    require(CVodeSetPreconditioner(cvode, FirstOrderProblem::prepare, FirstOrderProblem::precondition),
            CVodeGetLinReturnFlagName);
  } else {
    require(CVodeSetJacFn(cvode, FirstOrderProblem::jacobian<Part::whole>), CVodeGetLinReturnFlagName);
  }
}

}  // namespace

Trajectory cvode(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                 const SolveOptions& options) {
  check(times, t0, options);
  const FirstOrderOde first_order(ode, y0, t0);
  Cvode solver(first_order, *ode.work, t0, times.back(), options);
  Trajectory trajectory{{times.begin(), times.end()}, {}};
  for (double t : times)  // CVODE does not take a first output time that is no step away
    trajectory.states.push_back(first_order.state(t, t == t0 ? first_order.initial() : solver.advance(t)));
  solver.count_work(*ode.work);
  return trajectory;
}

}  // namespace drape::reference
