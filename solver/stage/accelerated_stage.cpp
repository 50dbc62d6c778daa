#include "solver/stage/accelerated_stage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::solver {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double forcing = 0.02;        ///< tolerance of an iterative solve over |r|
constexpr double growth = 4;            ///< growth of |d| that is accepted: Anderson's method is not monotone
constexpr double smallest_part = 1e-3;  ///< of an update; below it the iteration has failed
constexpr double similar_gamma = 0.1;   ///< relative difference of γ up to which the constant matrix is kept

}  // namespace

AcceleratedStage::AcceleratedStage(const SplitOde& ode, const Options& options, StageSystem& system)
    : ode_(ode),
      options_(options),
      system_(system),
      estimate_(ode),
      anderson_(ode.particles(), *ode.partition),
      newton_(ode, options, system),
      policy_(options.stage->matrix, ode),
      work_(*ode.work) {
  for (Vectors* field : {&guess_, &best_v_, &best_d_}) field->setZero(ode.particles(), 3);
}

StageResult AcceleratedStage::ended(Outcome outcome) {
  result_.outcome = outcome;
  return result_;
}

void AcceleratedStage::begin(const Stage& stage, const State& y) {
  stage_ = &stage;
  result_ = {};
  guess_ = y.v;
  newton_.begin();
  searched_ = false;
  start_iteration();
}

void AcceleratedStage::start_iteration() {
  best_ = infinity;
  estimate_.start();
  part_ = 1;
  rate_ = 0;
  improved_ = false;
}

/// Keeps the differences and estimates of the previous stage if it had the same P.
void AcceleratedStage::recycle() {
  if (newton_.matrix() == recycled_matrix_ && system_.gamma() == recycled_gamma_) {
    estimate_.next_stage();
    anderson_.begin();
  } else {
    estimate_.reset();
    anderson_.restart();
  }
}

/// Finds the P that the stage begins with; false, with the outcome, if that fails.
bool AcceleratedStage::find_matrix(State& y) {
  if (const std::optional<Jacobian> part = policy_.first_matrix()) {
    if (!newton_.choose(*part, stage_->gamma)) return renew_matrix(y);
  } else {
    result_.outcome = system_.prepare(stage_->gamma, stage_->inertia, similar_gamma);
  }
  recycle();
  return result_.outcome == Outcome::success;
}

/// Evaluates the Newton matrix at y and restarts the iteration with it; false, with the outcome, if that fails.
bool AcceleratedStage::renew_matrix(State& y) {
  start_iteration();
  estimate_.reset();
  anderson_.restart();
  result_.outcome = newton_.renew(*stage_, y);
  return result_.outcome == Outcome::success;
}

/// d = P⁻¹ r; false if the solve fails.
bool AcceleratedStage::correct() {
  const Vectors& r = system_.residual();
  size_ = infinity;
  if (!std::isfinite(estimate_.residual())) return true;
  const LinearResult solved =
      newton_.in_use() ? newton_.solve(r, system_.correction()) : system_.correct(forcing * estimate_.residual());
  result_.cg_iterations += solved.iterations;
  if (solved.outcome != Outcome::success) {
    result_.outcome = solved.outcome;
    return false;
  }
  size_ = system_.size(system_.correction());
  return true;
}

/// Returns to the best iterate and goes on from there in another way; false, with the outcome, if there is none.
bool AcceleratedStage::backtrack(State& y) {
  if (!std::isfinite(best_)) {
    result_.outcome = Outcome::not_finite;
    return false;
  }
  y.v = best_v_;
  if (newton_.in_use()) return improved_ ? renew_matrix(y) : search(y);
  anderson_.restart();
  part_ /= 4;
  rate_ = 0;
  if (part_ < smallest_part) return switch_to_newton(y);
  y.v += part_ * best_d_;
  return true;
}

/// The rest of the stage by Newton's method with line searches; false if that fails as well.
bool AcceleratedStage::search(State& y) {
  newton_.search(*stage_, guess_, y, result_);
  searched_ = true;
  return result_.outcome == Outcome::success;
}

/// Goes on with Newton's matrix if the policy allows it; else the stage has not converged.
bool AcceleratedStage::switch_to_newton(State& y) {
  if (!may_switch()) {
    result_.outcome = Outcome::not_converged;
    return false;
  }
  policy_.switched();
  y.v = best_v_;
  newton_.choose(Jacobian::tension, stage_->gamma);
  return renew_matrix(y);
}

void AcceleratedStage::advance(State& y) {
  estimate_.observe_update(size_);
  if (size_ <= best_) {
    improved_ = std::isfinite(best_);
    best_v_ = y.v;
    best_d_ = system_.correction();
  }
  rate_ = std::isfinite(best_) ? size_ / best_ : 0;
  best_ = std::min(best_, size_);
  if (part_ < 1) {
    y.v += part_ * system_.correction();
    part_ = std::min(1.0, 2 * part_);
  } else {
    anderson_.advance(y.v, system_.correction());
  }
}

bool AcceleratedStage::close_enough(const State& y) const {
  if (stage_->residual > 0) return false;
  const double error = estimate_.error(size_, anderson_.smallest_response());
  return part_ == 1 && error <= system_.allowed_error(*stage_, guess_, y);
}

StageResult AcceleratedStage::solve(const Stage& stage, State& y) {
  begin(stage, y);
  prescribe(ode_.pins, y.v);
  if (!find_matrix(y)) return result_;
  for (;;) {
    if (result_.updates >= options_.max_updates) return ended(Outcome::not_converged);
    system_.evaluate(stage, nullptr, y);
    system_.filter_residual(stage.gamma);
    estimate_.measure(system_.residual(), stage.gamma);
    if (result_.updates == 0) noise_ = system_.noise(y, stage.gamma);
    if (result_.updates > 0 && estimate_.residual() <= std::max(noise_, stage.residual)) break;
    if (!correct()) return result_;
    ++result_.updates;
    ++work_.updates;
    newton_.count_update();
    if (!(size_ <= (part_ < 1 ? 1 : growth) * best_)) {
      if (!backtrack(y)) return result_;
      if (searched_) break;
      continue;
    }
    advance(y);
    const bool close = close_enough(y);
    if (close && !(may_switch() && AutoPolicy::hides_errors(size_, estimate_.mass_scaled_residual()))) break;
    if (may_switch() && (close || AutoPolicy::too_long(result_.updates))) {
      if (!switch_to_newton(y)) return result_;
    } else if (newton_.stagnates(rate_, improved_)) {
      if (newton_.exhausted() ? !search(y) : !renew_matrix(y)) return result_;
      if (searched_) break;
    }
  }
  y.x = stage.ax + stage.gamma * y.v;
  recycled_matrix_ = newton_.matrix();
  recycled_gamma_ = system_.gamma();
  policy_.ended(result_.updates, newton_.renewals());
  return ended(Outcome::success);
}

}  // namespace drape::solver
