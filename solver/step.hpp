#pragma once

#include <algorithm>
#include <any>
#include <cmath>
#include <vector>

#include "solver/contact/impact_response.hpp"
#include "solver/history.hpp"
#include "solver/limit_watch.hpp"
#include "solver/linear/linearised_system.hpp"
#include "solver/linear/phi_functions.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::solver {

/// Stage::accuracy of methods that keep energies only as far as their stages are solved.
constexpr double exact_accuracy = 1e-10;

/// Fields that every step may overwrite.
struct Scratch {
  Vectors ax, av, f_hat;     ///< N × 3
  std::vector<State> rates;  ///< dy/dt of stages, for Runge-Kutta methods
};

/// The error of a step as far as its method provides it.
struct StepError {
  double constant = 0;     ///< c of the last stage: the error in v is c h^(p+1) times a derivative, p being the order
  bool embedded = false;   ///< whether the method has set `estimate`, by an embedded method
  State estimate;          ///< of x [m] and v [m/s]
  Vectors split;           ///< splitting error in v [m/s] of IMEX methods with error control
  double split_gamma = 0;  ///< splitting error in x over that in v [s]; 0: no splitting error
};

/// What methods need and keep from step to step that divide their steps, or choose their stages, by a stability limit.
struct SubStepping {
  ImpactResponse* impacts = nullptr;  ///< null if there are no obstacles
  double limit = 0;                   ///< largest stable sub-step, or 1 over the largest decay [s]; 0 until it is estimated
  LimitWatch limit_watch = {};        ///< either watch tells when the limit must be estimated again
  StretchWatch stretch_watch = {};
  std::int64_t &substeps, &limits;  ///< work counters
};

/// One step from t to t + h, for its method: it reads the history, whose newest point is (t, y0), writes y1 and adds up its
/// work in `result`.
struct Step {
  const SplitOde& ode;
  const Options& options;
  StageSolver* stage;            ///< null for methods that do not use it
  ContactResponse* contacts;     ///< of these stages, null if there are no obstacles
  LinearisedSystem* linearised;  ///< null unless the method's stages are linearised
  PhiFunctions* phi;             ///< null unless the method is exponential
  History& history;
  Point& next;  ///< at t + h: the result
  Scratch& scratch;
  SubStepping& sub_stepping;
  StepError& error;
  std::any& kept;  ///< empty until the method calls `keep`

  double t = 0;
  double h = 0;
  bool after_impact = false;  ///< no history after a hard impact or Start::jump: velocities may jump from particle to particle
  bool starting = false;      ///< whether another method takes the step, for lack of a history
  StageResult result = {};

  /// h over the step before, 0 without history.
  double w() const { return after_impact || history.last_step() == 0 ? 0 : h / history.last_step(); }

  Point& now() { return history[0]; }
  const State& y0() const { return history[0].y; }
  const State& ym1() const { return history[1].y; }
  State& y1() { return next.y; }

  /// What the method makes of the ODE at its first step and keeps.
  template <class Kept>
  Kept& keep() {
    if (!kept.has_value()) kept.emplace<Kept>(ode);
    return *std::any_cast<Kept>(&kept);
  }

  /// Ends a sub-step: what follows goes on from here. `recall` goes back to the newest point of the history.
  void pass(double time, State& y) const {
    if (!ode.memory) return;
    ode.memory->carry(time, y);
    ode.memory->pass(time, y);
  }
  void recall() const {
    if (ode.memory) ode.memory->pass(history[0].t, history[0].y);
  }

  /// f_expl of a point of this step, evaluated at most once.
  const Vectors& explicit_force(Point& point, double time) const {
    if (!point.has_f) ode.explicit_force(time, point.y.x, point.y.v, point.f);
    point.has_f = true;
    return point.f;
  }

  /// Solves a nonlinear stage; c as StepError::constant.
  bool solve(Stage given, double c) {
    State& y = next.y;
    y.v = y0().v;  // predictor (3.25), (3.32)
    error.constant = c;
    if (stage->accelerates()) {
      if (history.smooth() > 1) history.extrapolate(given.t, y.v);
      given.accuracy = options.stage_accuracy * std::min(1.0, error_over_extrapolation(given.t));
      if (!history.full()) given.accuracy *= 1e-2;  // the extrapolation is of a lower order than the step
      if (given.start != nullptr) given.accuracy = exact_accuracy;
    }
    return accept(stage->solve(given, y));
  }

  /// Solves the linear stage of an IMEX method, which ends the step. With error control, the difference of f_expl at the
  /// end and f̂ is part of the error: where hk/d is large it is all of it.
  void solve_split(const Stage& given, const Vectors& f_explicit, double c) {
    next.y.v = y0().v;  // predictor (3.25), (3.32)
    error.constant = c;
    if (!accept(stage->solve_linear(given, f_explicit, next.y)) || !options.error_control.enabled()) return;
    scratch.av = given.gamma * (explicit_force(next, given.t) - f_explicit);
    error.split = stage->respond(scratch.av, result);
    error.split_gamma = given.gamma;
  }

  /// Error of the step over the error of the history's extrapolation to `time`.
  double error_over_extrapolation(double time) const {
    return error.constant * std::pow(h, history.smooth()) / history.remainder(time);
  }

  /// Factors M − γ ∂f/∂v − γ² ∂f/∂x at a state.
  bool linearise(double gamma, double time, const State& y) {
    result.outcome = linearised->factor(gamma, time, y);
    return result.outcome == Outcome::success;
  }

  /// Solves with these factors, for velocities or for velocities and positions.
  template <class Field>
  void solve_linearised(const Field& r, Field& d) {
    linearised->solve(r, d);
    ++result.updates;
  }

  /// Adds the work of a stage; true if it succeeded.
  bool accept(const StageResult& stage_result) {
    result.outcome = stage_result.outcome;
    result.updates += stage_result.updates;
    result.cg_iterations += stage_result.cg_iterations;
    return result.outcome == Outcome::success;
  }
};

}  // namespace drape::solver
