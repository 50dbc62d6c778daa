#include <cmath>

#include "solver/stage/stage_solver.hpp"

namespace drape::solver {

// Pass i: b_i = b + p(x, v), CG from v until |b_i − A v| ≤ η |b_i|. It ends when CG takes no iteration   [Etzmuß 2002, Alg. 6].
// Here r = b_i − A v, and CG finds the correction of v from 0, which is the same.
StageResult StageSolver::printed_loop(const Stage& stage, State& y) {
  StageResult result;
  const auto ended = [&](Outcome outcome) { return StageResult{outcome, result.updates, result.cg_iterations}; };
  const Outcome prepared = system_.prepare(stage);
  if (prepared != Outcome::success) return ended(prepared);
  prescribe(ode_.pins, y.v);
  const int passes = options_.accepted_passes();
  for (;; ++result.updates, ++work_.updates) {
    if (passes > 0 && result.updates == passes) return y.x = stage.ax + stage.gamma * y.v, ended(Outcome::success);
    system_.evaluate(stage, nullptr, y);
    system_.filter_residual(stage.gamma);
    const double residual = system_.residual().norm();
    if (!std::isfinite(residual)) return ended(Outcome::not_finite);
    const double target = system_.scale(stage, y).target(options_.cg_tolerance);
    if (residual <= target) return ended(Outcome::success);
    if (result.updates == options_.max_updates) return ended(Outcome::not_converged);
    const LinearResult system = system_.correct(target);
    result.cg_iterations += system.iterations;
    y.v += system_.correction();
    if (system.outcome != Outcome::success) return ended(system.outcome);
  }
}

}  // namespace drape::solver
