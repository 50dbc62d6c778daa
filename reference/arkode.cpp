#include "reference/arkode.hpp"

#include <arkode/arkode_arkstep.h>

#include "reference/first_order_problem.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;

/// The rest is explicit.
enum class Implicit { everything, linear_part, nothing };

/// One integration from t0 to the end. ARKODE keeps the address of this object.
class Arkode {
 public:
  Arkode(const FirstOrderOde& ode, Implicit implicit, solver::Work& work, double t0, double end, const SolveOptions& options);

  /// y at time t, which must be after the last one asked for. Steps end there: interpolation would cost accuracy.
  Eigen::VectorXd advance(double t) {
    require(ARKStepSetStopTime(memory_.get(), t));
    double reached;
    require(ARKStepEvolve(memory_.get(), t, session_.y(), &reached, ARK_NORMAL));
    return values(session_.y());
  }

  void count_work(solver::Work& work) const {
    add_counts({{ARKStepGetNumSteps, "arkode/steps", "steps of ARKODE"},
                {ARKStepGetNumJacEvals, "arkode/jacobians", "Jacobians evaluated by ARKODE"},
                {ARKStepGetNumLinSolvSetups, "arkode/factorisations", "factorisations of the Newton matrix"}},
               memory_.get(), work);
  }

 private:
  void set_newton(Implicit implicit, const SolveOptions& options);

  void require(int flag, FlagName flag_name = ARKStepGetReturnFlagName) const {
    double reached = 0;
    ARKStepGetCurrentTime(memory_.get(), &reached);
    session_.require(flag, flag_name, reached);
  }

  Session session_;
  FirstOrderProblem problem_;
  Memory memory_;
};

void* create(Implicit implicit, double t0, Session& session) {
  using P = FirstOrderProblem;
  switch (implicit) {
    case Implicit::everything: return ARKStepCreate(nullptr, P::derivative<Part::whole>, t0, session.y(), session.context());
    case Implicit::nothing: return ARKStepCreate(P::derivative<Part::whole>, nullptr, t0, session.y(), session.context());
    case Implicit::linear_part: break;
  }
  return ARKStepCreate(P::derivative<Part::remainder>, P::derivative<Part::linear>, t0, session.y(), session.context());
}

Arkode::Arkode(const FirstOrderOde& ode, Implicit implicit, solver::Work& work, double t0, double end,
               const SolveOptions& options)
    : session_("ARKODE", "arkode", ode.size(), work, *options.newton),
      problem_{ode, session_},
      memory_(nullptr, [](void* memory) { ARKStepFree(&memory); }) {
  const auto atol = session_.new_vector();
  set_absolute_tolerances(atol.get(), end - t0, options);
  values(session_.y()) = ode.initial();

  memory_.reset(require_created(create(implicit, t0, session_)));
  void* const arkode = memory_.get();
  require(ARKStepSetErrHandlerFn(arkode, Session::on_error, &session_));
  require(ARKStepSetUserData(arkode, &problem_));
  require(ARKStepSVtolerances(arkode, options.rtol, atol.get()));
  require(ARKStepSetMaxNumSteps(arkode, options.max_steps));
  require(ARKStepSetOrder(arkode, options.max_order));
  if (implicit != Implicit::nothing) set_newton(implicit, options);
}

void Arkode::set_newton(Implicit implicit, const SolveOptions& options) {
  void* const arkode = memory_.get();
  // Without a predictor, or with less iterations, a step needs up to thirty times as many factorisations.
  require(ARKStepSetPredictorMethod(arkode, 1));
  require(ARKStepSetMaxNonlinIters(arkode, 8));
  require(ARKStepSetLinearSolver(arkode, session_.linear_solver(), session_.matrix()), ARKStepGetLinReturnFlagName);
  if (implicit == Implicit::linear_part) require(ARKStepSetLinear(arkode, 0));
  if (options.newton->reduced()) {
    problem_.reduced.emplace(problem_.ode.ode(), options.newton->matrix);
    require(ARKStepSetPreconditioner(arkode, FirstOrderProblem::prepare, FirstOrderProblem::precondition),
            ARKStepGetLinReturnFlagName);
    return;
  }
  const auto jacobian =
      implicit == Implicit::linear_part ? FirstOrderProblem::jacobian<Part::linear> : FirstOrderProblem::jacobian<Part::whole>;
  require(ARKStepSetJacFn(arkode, jacobian), ARKStepGetLinReturnFlagName);
}

Trajectory solve(Implicit implicit, const solver::SplitOde& ode, const solver::State& y0, double t0,
                 std::span<const double> times, const SolveOptions& options) {
  check(times, t0, options);
  const FirstOrderOde first_order(ode, y0, t0);
  Arkode solver(first_order, implicit, *ode.work, t0, times.back(), options);
  Trajectory trajectory{{times.begin(), times.end()}, {}};
  for (double t : times) trajectory.states.push_back(first_order.state(t, t == t0 ? first_order.initial() : solver.advance(t)));
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

}  // namespace drape::reference
