#include "solver/stage/stage_solver.hpp"

#include <algorithm>
#include <cmath>

#include "solver/stage/accelerated_loop.hpp"

namespace drape::solver {

StageSolver::StageSolver(const SplitOde& ode, const Options& options, ContactResponse* contacts)
    : ode_(ode), options_(options), system_(ode, options, contacts), work_(*ode.work) {
  if (options.stage->accelerated) accelerated_ = std::make_unique<AcceleratedLoop>(ode, options_, system_);
}

StageSolver::~StageSolver() = default;

StageResult StageSolver::solve_linear(const Stage& stage, const Vectors& f_explicit, State& y) {
  return solve(stage, &f_explicit, y);
}

StageResult StageSolver::solve(const Stage& stage, State& y) {
  return accelerates() ? accelerated_->solve(stage, y) : solve(stage, nullptr, y);
}

const Vectors& StageSolver::respond(const Vectors& r, StageResult& result) {
  const LinearResult system = system_.respond(r, options_.cg_tolerance);
  result.outcome = system.outcome;
  result.cg_iterations += system.iterations;
  return system_.correction();
}

StageResult StageSolver::solve(const Stage& stage, const Vectors* f_explicit, State& y) {
  StageResult result;
  result.outcome = system_.prepare(stage.gamma);
  if (result.outcome != Outcome::success) return result;
  prescribe(ode_.pins, y.v);
  const auto ended = [&](Outcome outcome) { return StageResult{outcome, result.updates, result.cg_iterations}; };

  const bool linear = f_explicit != nullptr, contacts = system_.touches();
  const double loop_tolerance = linear ? options_.cg_tolerance : options_.loop_tolerance;
  const double cg_tolerance =
      linear ? loop_tolerance : std::min(options_.cg_tolerance, loop_tolerance / 2);  // or it could not end
  const int changing_updates = linear ? 10 : 50;
  StageSystem::Scale size{};
  for (;; ++result.updates, ++work_.updates) {
    system_.evaluate(stage, f_explicit, y);
    const bool solved = result.updates > 0;
    const bool changed =
        contacts && solved &&
        system_.adapt_contacts(stage, f_explicit, y, size.target(loop_tolerance), result.updates >= changing_updates);
    const double whole = contacts ? system_.residual().norm() : 0;
    system_.filter_residual(stage.gamma);
    if (!solved) size = system_.scale(y, stage.gamma);
    size.round_off = std::max(size.round_off, StageSystem::round_off(whole));

    const double residual = system_.residual().norm();
    if (!std::isfinite(residual)) return ended(Outcome::not_finite);
    const bool guessed = !linear && !contacts && residual <= size.target(cg_tolerance);
    if (solved ? !changed && residual <= size.target(loop_tolerance) : guessed) return ended(Outcome::success);
    if (result.updates == options_.max_updates) return ended(Outcome::not_converged);

    const LinearResult system = system_.correct(size.target(cg_tolerance));
    result.cg_iterations += system.iterations;
    y.v += system_.correction();
    if (linear && !contacts) {
      y.x = stage.ax + stage.gamma * y.v;
      ++work_.updates;
      return {system.outcome, 1, system.iterations};
    }
    if (system.outcome != Outcome::success) return ended(system.outcome);
  }
}

}  // namespace drape::solver
