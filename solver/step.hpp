#pragma once

#include "solver/impact_response.hpp"
#include "solver/stage_solver.hpp"

namespace drape::solver {

/// A state on the trajectory with what a method keeps of it: f_expl for the IMEX methods, the whole force for `verlet`.
struct Point {
  State y;
  Vectors f;
  bool has_f = false;
};

/// What a method sees of one step from t to t + h: it reads y0 (and y₋₁), writes y1 and adds up its work in `result`.
struct Step {
  const SplitOde& ode;
  const Options& options;
  StageSolver* stage;  ///< null for explicit methods, which need no matrix

  double t = 0;
  double h = 0;
  double w = 0;               ///< h over the step before, 0 if there is none
  bool after_impact = false;  ///< there is none because of a hard impact: velocities may jump from particle to particle
  Point before;               ///< at t − h/w
  Point now;                  ///< at t
  Point next;                 ///< at t + h: the result

  Vectors ax, av, f_hat;  ///< scratch, N × 3

  ImpactResponse* impacts = nullptr;  ///< for explicit methods; null if there are no obstacles
  double explicit_limit = 0;          ///< largest stable sub-step of `verlet` [s], 0 until it is known
  std::int64_t& substeps;             ///< work counter

  StageResult result;

  const State& y0() const { return now.y; }
  const State& ym1() const { return before.y; }
  State& y1() { return next.y; }

  /// f_expl of a point of this step, evaluated at most once.
  const Vectors& explicit_force(Point& point, double time) {
    if (!point.has_f) ode.explicit_force(time, point.y.x, point.y.v, point.f);
    point.has_f = true;
    return point.f;
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
