#include <cmath>

#include "solver/stage/stage_solver.hpp"

namespace drape::solver {

StageResult StageSolver::one_system(const Stage& stage, const Vectors& f_explicit, State& y) {
  const Outcome prepared = system_.prepare(stage);
  if (prepared != Outcome::success) return {prepared, 0, 0};
  prescribe(ode_.pins, y.v);
  system_.evaluate(stage, &f_explicit, y);
  system_.filter_residual(stage.gamma);
  if (!std::isfinite(system_.size(system_.residual()))) return {Outcome::not_finite, 0, 0};
  const LinearResult solved = system_.correct(system_.scale(stage, y).target(options_.cg_tolerance));
  y.v += system_.correction();
  y.x = stage.ax + stage.gamma * y.v;
  ++work_.updates;
  return {solved.outcome, 1, solved.iterations};
}

StageResult StageSolver::solve_increment(double gamma, const State& y, const State& r, State& k) {
  const Outcome prepared = system_.prepare(gamma, 1);
  if (prepared != Outcome::success) return {prepared, 0, 0};
  const LinearResult solved = system_.respond(r, options_.cg_tolerance, system_.noise(y, gamma));
  k.v = system_.correction();
  k.x = r.x + gamma * k.v;
  ++work_.updates;
  return {solved.outcome, 1, solved.iterations};
}

}  // namespace drape::solver
