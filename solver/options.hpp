#pragma once

#include <span>
#include <string_view>

#include "solver/linear/preconditioner.hpp"

namespace drape::solver {

/// Step control by loop iterations [Etzmuß 2002, 3.4.3]: the step shrinks by `factor` when a step took more than
/// `max_updates` or did not converge, and grows by it after fewer than `min_updates`.
struct StepControl {
  int min_updates = 0;
  int max_updates = 0;  ///< 0: constant steps
  double factor = 1.5;

  bool enabled() const { return max_updates > 0; }
};

/// Steps whose estimated local error stays below a tolerance: the root mean square of positions relative to `length` and
/// velocities relative to length/duration, as in the references. Or a global error near it, measured by pilot runs.
struct ErrorControl {
  double tolerance = 0;  ///< 0: constant steps
  double length = 1;     ///< size of the scene [m]
  double duration = 1;   ///< of the run [s]
  bool global = false;   ///< whether the tolerance limits the error of positions at all tenths of the run instead
  int most_steps =
      100'000;  ///< accepted and rejected ones, after which a run ends; a run that needs more for a global error is not begun

  bool enabled() const { return tolerance > 0; }
};

/// How the nonlinear stages of a method are solved.
struct StageKind {
  std::string_view name;
  std::string_view description;
  enum class Matrix { constant, newton, tension_newton, chosen } matrix;
  bool accelerated = false;  ///< by Anderson's method, until the estimated error is small; else until the residual is small
  enum class Iteration { loop, printed_loop, chebyshev, lbfgs, vertices } iteration = Iteration::loop;  ///< if not accelerated
  int passes = 0;  ///< updates after which a stage counts as solved, 0: when its residual is small
};

/// All stage solvers; the first is the default.
std::span<const StageKind> stage_kinds();

/// The stage solver with this name. Throws std::invalid_argument, listing the names.
const StageKind& stage_kind(std::string_view name);

/// Options set by the caller. Tolerances are relative to |b|, the right-hand side of the step's linear system.
struct Options {
  double loop_tolerance = 1e-5;  ///< of the fixed-point loop: |b(x, v) − A v| ≤ η |b|
  double cg_tolerance = 2e-4;    ///< of a linear solve; inside the loop never looser than half the loop's
  int max_updates = 2000;        ///< fixed-point updates a stage before it counts as not converged
  int max_cg_iterations = 5000;  ///< iterations a linear solve before it counts as not converged
  double verlet_fraction = 0.9;  ///< sub-step of `verlet` as a fraction of its stability limit
  int sub_steps = 20;            ///< of `xpbd` a step
  int sweeps = 1;                ///< over all constraints a sub-step, or over all rows of the matrix a step
  StepControl control;
  ErrorControl error_control;
  bool ends_at_kinks = false;   ///< whether steps end where forces that remember the motion have kinks: event location
  double stage_accuracy = 0.1;  ///< error left in an accelerated stage over the error of the time step
  int passes = 0;  ///< updates after which a stage that is not accelerated counts as solved [Etzmuß 2002, 3.4.3], 0: its kind's

  /// Assumed spectral radius of the loop that `chebyshev` accelerates; the best one depends on scene and step.
  double chebyshev_radius = 0.97;

  const StageKind* stage = &stage_kinds().front();
  const LinearSolver* linear_solver = &linear_solvers().front();

  /// Updates after which a stage that is not accelerated counts as solved, 0: when its residual is small.
  int accepted_passes() const { return passes > 0 ? passes : stage->passes; }
};

/// The options of the thesis: the fixed-point loop and CG with IC(0)   [Etzmuß 2002, 3.4].
Options thesis_options();

}  // namespace drape::solver
