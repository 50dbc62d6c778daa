#include "reference/sundials/multirate.hpp"

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_mristep.h>

#include <algorithm>
#include <cmath>

#include "reference/sundials/first_order_problem.hpp"
#include "solver/stability.hpp"

namespace drape::reference {
namespace {

using namespace sundials_tools;

/// Tolerance of the fast part over that of the whole.
constexpr double fast_part = 0.1;

/// Slow steps to begin with at least, and how often they are halved at most.
constexpr int fewest_slow_steps = 10, most_halvings = 17;

/// ω h of the first slow steps: explicit methods of order 4 are stable up to about 2.8.
constexpr double stable_slow_step = 2;

/// One integration from t0 to the end with one slow step. ARKODE keeps the address of this object.
class Multirate {
 public:
  Multirate(const FirstOrderOde& ode, double step, double t0, double end, const SolveOptions& options);

  /// y at time t, which must be after that of the last call.
  const solver::State& advance(double t) {
    require(MRIStepSetStopTime(slow_.get(), t));
    double reached;
    require(MRIStepEvolve(slow_.get(), t, y_.get(), &reached, ARK_NORMAL));
    return state(y_.get());
  }

  void count_work(solver::Counters& work) const {
    add_counts({{MRIStepGetNumSteps, "multirate/slow_steps", "steps of the multirate method"}}, slow_.get(), work);
    add_counts({{ARKStepGetNumSteps, "multirate/fast_steps", "steps of its fast part"}}, fast_.get(), work);
  }

 private:
  void set_fast(double step, const SolveOptions& options);
  void set_slow(double step, const SolveOptions& options);

  void require(int flag, FlagName flag_name = MRIStepGetReturnFlagName) const {
    double reached = 0;
    if (slow_) MRIStepGetCurrentTime(slow_.get(), &reached);
    session_.require(flag, flag_name, reached);
  }

  Session session_;
  Owned<N_Vector> y_;
  FirstOrderProblem problem_;
  Owned<N_Vector> atol_;
  Memory fast_;
  std::unique_ptr<_MRIStepInnerStepper, void (*)(MRIStepInnerStepper)> stepper_;
  Memory slow_;
};

Multirate::Multirate(const FirstOrderOde& ode, double step, double t0, double end, const SolveOptions& options)
    : session_("MRIStep"),
      y_(start_vector(ode, session_)),
      problem_{ode, session_},
      atol_(absolute_tolerances(y_, end - t0, options)),
      fast_(require_created(
                ARKStepCreate(FirstOrderProblem::derivative<Part::linear>, nullptr, t0, y_.get(), session_.context())),
            [](void* memory) { ARKStepFree(&memory); }),
      stepper_(nullptr, [](MRIStepInnerStepper stepper) { MRIStepInnerStepper_Free(&stepper); }),
      slow_(nullptr, [](void* memory) { MRIStepFree(&memory); }) {
  set_fast(step, options);
  slow_.reset(require_created(MRIStepCreate(FirstOrderProblem::derivative<Part::remainder>, nullptr, t0, y_.get(),
                                            stepper_.get(), session_.context())));
  set_slow(step, options);
}

void Multirate::set_fast(double step, const SolveOptions& options) {
  void* const fast = fast_.get();
  require(ARKStepSetErrHandlerFn(fast, Session::on_error, &session_), ARKStepGetReturnFlagName);
  require(ARKStepSetUserData(fast, &problem_), ARKStepGetReturnFlagName);
  N_VScale(fast_part, atol_.get(), atol_.get());
  require(ARKStepSVtolerances(fast, fast_part * options.rtol, atol_.get()), ARKStepGetReturnFlagName);
  require(ARKStepSetMaxNumSteps(fast, options.max_steps), ARKStepGetReturnFlagName);
  require(ARKStepSetOrder(fast, options.max_order), ARKStepGetReturnFlagName);
  require(ARKStepSetInitStep(fast, 1e-3 * step), ARKStepGetReturnFlagName);
  MRIStepInnerStepper stepper = nullptr;
  require(ARKStepCreateMRIStepInnerStepper(fast, &stepper), ARKStepGetReturnFlagName);
  stepper_.reset(stepper);
}

void Multirate::set_slow(double step, const SolveOptions& options) {
  void* const slow = slow_.get();
  require(MRIStepSetErrHandlerFn(slow, Session::on_error, &session_));
  require(MRIStepSetUserData(slow, &problem_));
  require(MRIStepSetMaxNumSteps(slow, options.max_steps));
  require(MRIStepSetFixedStep(slow, step));
  const std::unique_ptr<MRIStepCouplingMem, decltype(&MRIStepCoupling_Free)> coupling(
      require_created(MRIStepCoupling_LoadTable(ARKODE_MRI_GARK_ERK45a)), MRIStepCoupling_Free);
  require(MRIStepSetCoupling(slow, coupling.get()));  // it keeps a copy
}

Trajectory with_slow_step(const FirstOrderOde& ode, double step, double t0, std::span<const double> times,
                          const SolveOptions& options) {
  Multirate solver(ode, step, t0, times.back(), options);
  Trajectory trajectory{{times.begin(), times.end()}, {}};
  for (double t : times) trajectory.states.push_back(ode.output(t, t == t0 ? ode.initial() : solver.advance(t)));
  solver.count_work(*ode.ode().work);
  return trajectory;
}

/// The largest root mean square at an output time of a change over |y| + scale.
double change(const Trajectory& a, const Trajectory& b, double size, double duration) {
  const auto relative = [](const solver::Vectors& from, const solver::Vectors& to, double scale) {
    return ((to - from).array() / (to.array().abs() + scale)).square().mean();
  };
  double largest = 0;
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    const double x = relative(a.states[k].x, b.states[k].x, size), v = relative(a.states[k].v, b.states[k].v, size / duration);
    largest = std::max(largest, std::sqrt((x + v) / 2));
  }
  return largest;
}

}  // namespace

Trajectory arkode_multirate(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                            const SolveOptions& options) {
  check(times, t0, options);
  const FirstOrderOde first_order(ode, y0, t0);
  if (options.tuning.step > 0) return with_slow_step(first_order, options.tuning.step, t0, times, options);
  const double duration = times.back() - t0;
  const double omega = std::sqrt(solver::spectrum(ode, t0, first_order.initial()).omega_squared);
  double step = std::min(duration / fewest_slow_steps, omega > 0 ? stable_slow_step / omega : duration);
  Trajectory before = with_slow_step(first_order, step, t0, times, options);
  for (int k = 0; k < most_halvings; ++k) {
    step /= 2;
    Trajectory now = with_slow_step(first_order, step, t0, times, options);
    if (change(before, now, options.size, duration) <= options.rtol) return now;
    before = std::move(now);
  }
  throw ReferenceError("MRIStep: slow steps were halved as often as allowed, and still the motion changes", "", t0);
}

}  // namespace drape::reference
