#include "solver/stage/stage_iteration.hpp"

#include <algorithm>
#include <cmath>

#include "solver/stage/chebyshev.hpp"
#include "solver/stage/lbfgs.hpp"
#include "solver/stage/loop_tolerance.hpp"
#include "solver/stage/vertex_descent.hpp"

namespace drape::solver {

StageIteration::StageIteration(const SplitOde& ode, const Options& options, StageSystem& system)
    : ode_(ode), options_(options), system_(system), work_(*ode.work) {}

void StageIteration::evaluate(const Stage& stage, State& y) {
  system_.evaluate(stage, nullptr, y);
  system_.filter_residual(stage.gamma);
}

StageResult StageIteration::solve(const Stage& stage, State& y) {
  StageResult result;
  const auto ended = [&](Outcome outcome) { return StageResult{outcome, result.updates, result.cg_iterations}; };
  const Outcome prepared = system_.prepare(stage);
  if (prepared != Outcome::success) return ended(prepared);
  prescribe(ode_.pins, y.v);
  evaluate(stage, y);
  const StageSystem::Scale size = system_.scale(stage, y);
  const double tolerance = loop_tolerance(options_, stage);
  const double end = stage.residual > 0 ? stage.residual : size.target(tolerance);
  const double linear_target = stage.residual > 0 ? end / 2 : size.target(std::min(options_.cg_tolerance, tolerance / 2));
  const int passes = options_.accepted_passes();
  begin(y);
  for (;; ++result.updates, ++work_.updates) {
    const double residual = system_.residual().norm();
    if (!std::isfinite(residual)) return ended(Outcome::not_finite);
    const double target = result.updates > 0 ? end : linear_target;
    if (passes > 0 ? result.updates == passes : residual <= target) return ended(Outcome::success);
    if (result.updates == options_.max_updates) return ended(Outcome::not_converged);
    const LinearResult advanced = advance(stage, y, linear_target);
    result.cg_iterations += advanced.iterations;
    if (advanced.outcome != Outcome::success) return ended(advanced.outcome);
  }
}

std::unique_ptr<StageIteration> make_iteration(const SplitOde& ode, const Options& options, StageSystem& system) {
  using Iteration = StageKind::Iteration;
  switch (options.stage->iteration) {
    case Iteration::chebyshev: return std::make_unique<ChebyshevLoop>(ode, options, system);
    case Iteration::lbfgs: return std::make_unique<Lbfgs>(ode, options, system);
    case Iteration::vertices: return std::make_unique<VertexDescent>(ode, options, system);
    case Iteration::loop:
    case Iteration::printed_loop: break;
  }
  return nullptr;
}

}  // namespace drape::solver
