#include "solver/stage/newton_search.hpp"

#include <algorithm>
#include <cmath>

namespace drape::solver {
namespace {

constexpr int most_matrices = 200;    ///< in a stage
constexpr int most_trials = 30;       ///< along an update
constexpr double left = 0.5;          ///< slope over the first one at which a line search ends
constexpr double inside = 0.1;        ///< least distance of a trial from the ends of its interval, over its length
constexpr double least_ahead = 0.01;  ///< lower bound of 1 − rate of convergence in the error estimate

}  // namespace

NewtonSearch::NewtonSearch(const SplitOde& ode, const Options& options, StageSystem& system)
    : options_(options),
      system_(system),
      work_(*ode.work),
      stages_(ode.work->counter("searched_stages", "stages solved by Newton's method with line searches")) {
  for (Vectors* field : {&from_, &d_}) field->setZero(ode.particles(), 3);
}

void NewtonSearch::evaluate(const Stage& stage, State& y) {
  system_.evaluate(stage, nullptr, y);
  system_.filter_residual(stage.gamma);
}

double NewtonSearch::slope() const { return (system_.residual().array() * d_.array()).sum(); }

/// Adds the part of d at which the slope has fallen, and evaluates the residual there; false if none is found.
bool NewtonSearch::follow(const Stage& stage, State& y) {
  from_ = y.v;
  const double start = slope();
  double low = 0, at_low = start, high = 0, at_high = 0, part = 1;
  for (int k = 0; k < most_trials; ++k) {
    y.v = from_ + part * d_;
    evaluate(stage, y);
    const double at = slope();
    if (std::abs(at) <= left * start || (at > 0 && part == 1)) return true;
    if (at > 0) {
      low = part, at_low = at;
    } else {
      high = part, at_high = std::isfinite(at) ? at : -start / inside;
    }
    const double margin = inside * (high - low);
    part = std::clamp((high * at_low - low * at_high) / (at_low - at_high), low + margin, high - margin);
  }
  return false;
}

void NewtonSearch::solve(const Stage& stage, const Vectors& guess, NewtonSystem& newton, State& y, StageResult& result) {
  ++stages_;
  const double noise = system_.noise(y, stage.gamma);
  double before = 0;  // |d| of the previous update
  evaluate(stage, y);
  for (int k = 0; k < most_matrices && result.updates < options_.max_updates; ++k) {
    result.outcome = Outcome::not_finite;
    if (!y.v.allFinite() || !system_.residual().allFinite()) return;
    result.outcome = newton.renew(stage, y);
    if (result.outcome != Outcome::success) return;
    const LinearResult solved = newton.solve(system_.residual(), d_);
    result.cg_iterations += solved.iterations;
    result.outcome = solved.outcome;
    if (result.outcome != Outcome::success) return;
    ++result.updates;
    ++work_.updates;
    const double size = d_.norm(), rate = before > 0 ? size / before : 1;
    const double error = size / std::max(1 - rate, least_ahead);
    if (stage.residual == 0 && error <= system_.allowed_error(stage, guess, y)) {
      y.v += d_;
      return;
    }
    if (!follow(stage, y)) break;
    if (system_.residual().norm() <= std::max(noise, stage.residual)) return;
    before = size;
  }
  result.outcome = Outcome::not_converged;
}

}  // namespace drape::solver
