#include "solver/stage/stage_solver.hpp"

#include <algorithm>

#include "solver/stage/accelerated_stage.hpp"
#include "solver/stage/stage_iteration.hpp"

namespace drape::solver {

StageSolver::StageSolver(const SplitOde& ode, const Options& options, ContactResponse* contacts)
    : ode_(ode), options_(options), system_(ode, options, contacts), work_(*ode.work) {
  if (options.stage->accelerated)
    accelerated_ = std::make_unique<AcceleratedStage>(ode, options_, system_);
  else
    iteration_ = make_iteration(ode, options_, system_);
  if (contacts != nullptr && options.stage->accelerated) in_contact_.emplace(ode.particles());
}

StageSolver::~StageSolver() = default;

StageResult StageSolver::solve_linear(const Stage& stage, const Vectors& f_explicit, State& y) {
  return meet_pairs(stage, &f_explicit, y,
                    system_.touches() ? fixed_point(stage, &f_explicit, y) : one_system(stage, f_explicit, y));
}

StageResult StageSolver::solve(const Stage& stage, State& y) { return meet_pairs(stage, nullptr, y, solve_once(stage, y)); }

/// Solves again while the solution brings pairs of the cloth together that have no constraint.
StageResult StageSolver::meet_pairs(const Stage& stage, const Vectors* f_explicit, State& y, StageResult result) {
  while (result.outcome == Outcome::success && system_.finds_pairs(stage, y)) {
    const StageResult again = fixed_point(stage, f_explicit, y);
    result = {again.outcome, result.updates + again.updates, result.cg_iterations + again.cg_iterations};
  }
  return result;
}

StageResult StageSolver::solve_once(const Stage& stage, State& y) {
  if (system_.touches()) return fixed_point(stage, nullptr, y);
  if (accelerated_) return accelerated_->solve(stage, y);
  if (iteration_) return iteration_->solve(stage, y);
  const bool printed = options_.stage->iteration == StageKind::Iteration::printed_loop;
  return printed ? printed_loop(stage, y) : fixed_point(stage, nullptr, y);
}

const Vectors& StageSolver::solve_damping(double gamma, const Vectors& r, StageResult& result) {
  result.outcome = system_.prepare_damping(gamma);
  if (result.outcome != Outcome::success) return system_.correction();
  ++work_.updates;
  ++result.updates;
  return respond(r, result);
}

const Vectors& StageSolver::respond(const Vectors& r, StageResult& result) {
  const LinearResult system = system_.respond(r, std::max(options_.cg_tolerance, StageSystem::round_off(1)));
  result.outcome = system.outcome;
  result.cg_iterations += system.iterations;
  return system_.correction();
}

}  // namespace drape::solver
