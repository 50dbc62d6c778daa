#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/contact/impact_response.hpp"
#include "solver/history.hpp"
#include "solver/limit_watch.hpp"
#include "solver/stage/stage_solver.hpp"

namespace drape::solver {

/// Fields that every step may overwrite.
struct Scratch {
  Vectors ax, av, f_hat;     ///< N × 3
  std::vector<State> rates;  ///< dy/dt of stages, for Runge-Kutta methods
};

/// What a step says of its error.
struct StepError {
  double constant = 0;     ///< c of the last stage: the error in v is c h^(p+1) times a derivative, p being the order
  bool embedded = false;   ///< whether the method has found the error itself, by one that is embedded in it,
  State estimate;          ///< which is this
  Vectors split;           ///< in v, of IMEX methods with error control
  double split_gamma = 0;  ///< makes it one in x [s]
};

/// What methods need, and keep from step to step, that divide their steps or choose their stages by a stability limit.
struct SubStepping {
  ImpactResponse* impacts = nullptr;  ///< null if there are no obstacles
  double limit = 0;                   ///< largest stable sub-step, or 1 over the largest decay [s]; 0 until it is known
  LimitWatch limit_watch = {};        ///< tells when it has to be estimated anew, as does
  StretchWatch stretch_watch = {};
  std::int64_t &substeps, &limits;  ///< work counters
};

/// What a method sees of one step from t to t + h: it reads the history, whose newest point is (t, y0), writes y1 and adds up
/// its work in `result`.
struct Step {
  const SplitOde& ode;
  const Options& options;
  StageSolver* stage;  ///< null for explicit methods, which need no matrix
  History& history;
  Point& next;  ///< at t + h: the result
  Scratch& scratch;
  SubStepping& sub_stepping;

  double t = 0;
  double h = 0;
  double w = 0;               ///< h over the step before, 0 if there is none
  bool after_impact = false;  ///< there is none because of a hard impact: velocities may jump from particle to particle
  bool starting = false;      ///< whether another method takes the step, for lack of a history
  StepError error = {};
  StageResult result = {};

  Point& now() { return history[0]; }
  const State& y0() const { return history[0].y; }
  const State& ym1() const { return history[1].y; }
  State& y1() { return next.y; }

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
      given.accuracy = options.stage_accuracy * std::min(1.0, error_over_miss(given.t));
      if (!history.full()) given.accuracy *= 1e-2;  // the miss is of a lower order than the error
    }
    return accept(stage->solve(given, y));
  }

  /// Solves the linear stage of an IMEX method, which ends the step. With error control, what f̂ missed of f_expl at the end is
  /// a part of the error: where hk/d is large it is all of it.
  void solve_split(const Stage& given, const Vectors& f_explicit, double c) {
    next.y.v = y0().v;  // predictor (3.25), (3.32)
    error.constant = c;
    if (!accept(stage->solve_linear(given, f_explicit, next.y)) || !options.error_control.enabled()) return;
    scratch.av = given.gamma * (explicit_force(next, given.t) - f_explicit);
    error.split = stage->respond(scratch.av, result);
    error.split_gamma = given.gamma;
  }

  /// The error of the step over what the extrapolation of the history to time t misses.
  double error_over_miss(double time) const { return error.constant * std::pow(h, history.smooth()) / history.remainder(time); }

  /// Adds the work of a stage; true if it succeeded.
  bool accept(const StageResult& stage_result) {
    result.outcome = stage_result.outcome;
    result.updates += stage_result.updates;
    result.cg_iterations += stage_result.cg_iterations;
    return result.outcome == Outcome::success;
  }
};

}  // namespace drape::solver
