#include "solver/stage/accelerated_loop.hpp"

#include <cmath>
#include <stdexcept>

namespace drape::solver {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double forcing = 0.02;          ///< tolerance of an iterative solve over |r|
constexpr double growth = 4;              ///< an update that makes |d| grow more leads away: Anderson's method is not monotone
constexpr double smallest_part = 1e-3;    ///< of an update; below it there is no way on
constexpr double slow_rate = 0.3;         ///< a Newton matrix that converges slower is renewed,
constexpr int patience = 6;               ///< or after this number of updates,
constexpr int most_patience = 12;         ///< even if it was made for this stage,
constexpr double different_gamma = 0.25;  ///< or for a γ so far away
constexpr double similar_gamma = 0.1;     ///< the constant matrix serves for a γ as near as this
constexpr int most_renewals = 4;          ///< of a matrix in a stage; then every update needs one

}  // namespace

AcceleratedLoop::AcceleratedLoop(const SplitOde& ode, const Options& options, StageSystem& system)
    : ode_(ode),
      options_(options),
      system_(system),
      estimate_(ode),
      anderson_(ode.particles()),
      newton_(ode, options, system, Jacobian::whole),
      tension_newton_(ode, options, system, Jacobian::tension),
      search_(ode, options, system),
      policy_(*ode.work),
      work_(*ode.work) {
  const bool newton = options.stage->matrix == Matrix::newton || options.stage->matrix == Matrix::tension_newton;
  if (newton && !ode.newton_matrix) throw std::invalid_argument("stage solver 'newton': expected an ODE with a newton_matrix");
  for (Vectors* field : {&guess_, &best_v_, &best_d_}) field->setZero(ode.particles(), 3);
}

StageResult AcceleratedLoop::ended(Outcome outcome) {
  result_.outcome = outcome;
  return result_;
}

/// Which Newton matrix a stage begins with, if with any.
NewtonSystem* AcceleratedLoop::preferred() {
  switch (options_.stage->matrix) {
    case Matrix::newton: return &newton_;
    case Matrix::tension_newton: return &tension_newton_;
    case Matrix::chosen: return policy_.prefers_newton() ? &tension_newton_ : nullptr;
    case Matrix::constant: break;
  }
  return nullptr;
}

void AcceleratedLoop::begin(const Stage& stage, const State& y) {
  stage_ = &stage;
  result_ = {};
  guess_ = y.v;
  matrix_ = nullptr;
  renewals_here_ = 0;
  searched_ = false;
  start_iteration();
}

void AcceleratedLoop::start_iteration() {
  best_ = infinity;
  estimate_.start();
  part_ = 1;
  rate_ = 0;
  since_renewal_ = 0;
  made_here_ = true;
}

/// With another P the iteration is another one.
void AcceleratedLoop::reset() {
  start_iteration();
  estimate_.reset();
  anderson_.restart();
}

/// Takes over what the stage before has learnt of the iteration, if it was the same.
void AcceleratedLoop::recycle() {
  if (matrix_ == recycled_matrix_ && system_.gamma() == recycled_gamma_) {
    estimate_.next_stage();
    anderson_.begin();
  } else {
    estimate_.reset();
    anderson_.restart();
  }
}

/// Finds the P that the stage begins with; false, with the outcome, if there is none.
bool AcceleratedLoop::find_matrix(State& y) {
  matrix_ = preferred();
  if (matrix_ == nullptr) {
    result_.outcome = system_.prepare(stage_->gamma, similar_gamma);
  } else {
    const bool usable = !matrix_->empty() && std::abs(matrix_->gamma() / stage_->gamma - 1) <= different_gamma;
    if (!usable) return use_newton(matrix_, y);
    made_here_ = false;
  }
  recycle();
  return result_.outcome == Outcome::success;
}

/// Makes the matrix at y; false, with the outcome, if that is impossible.
bool AcceleratedLoop::use_newton(NewtonSystem* matrix, State& y) {
  matrix_ = matrix;
  reset();
  y.x = stage_->ax + stage_->gamma * y.v;
  ++renewals_here_;
  result_.outcome = matrix->renew(stage_->t, y, stage_->gamma);
  return result_.outcome == Outcome::success;
}

/// d = P⁻¹ r; false if the solve fails.
bool AcceleratedLoop::correct() {
  const Vectors& r = system_.residual();
  size_ = infinity;
  if (!std::isfinite(estimate_.residual())) return true;
  const LinearResult solved =
      matrix_ != nullptr ? matrix_->solve(r, system_.correction()) : system_.correct(forcing * estimate_.residual());
  result_.cg_iterations += solved.iterations;
  if (solved.outcome != Outcome::success) {
    result_.outcome = solved.outcome;
    return false;
  }
  size_ = system_.correction().norm();
  return true;
}

/// Back to the best iterate; false if there is no way on from there.
bool AcceleratedLoop::backtrack(State& y) {
  if (!std::isfinite(best_)) {
    result_.outcome = Outcome::not_finite;
    return false;
  }
  y.v = best_v_;
  if (matrix_ != nullptr) return made_here_ ? search(y) : use_newton(matrix_, y);
  anderson_.restart();
  part_ /= 4;
  rate_ = 0;
  if (part_ < smallest_part) return switch_to_newton(y);
  y.v += part_ * best_d_;
  return true;
}

/// The rest of the stage by Newton's method with line searches; false if that fails as well.
bool AcceleratedLoop::search(State& y) {
  const int updates = result_.updates;
  search_.solve(*stage_, guess_, newton_, y, result_);
  renewals_here_ += result_.updates - updates;
  searched_ = true;
  return result_.outcome == Outcome::success;
}

bool AcceleratedLoop::may_switch() const {
  return options_.stage->matrix == Matrix::chosen && ode_.newton_matrix && matrix_ == nullptr;
}

/// On with Newton's matrix where `auto` may; not converged otherwise.
bool AcceleratedLoop::switch_to_newton(State& y) {
  if (!may_switch()) {
    result_.outcome = Outcome::not_converged;
    return false;
  }
  policy_.switched();
  y.v = best_v_;
  return use_newton(&tension_newton_, y);
}

void AcceleratedLoop::advance(State& y) {
  estimate_.see_update(size_);
  if (size_ <= best_) {
    made_here_ = matrix_ == nullptr || !std::isfinite(best_);
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

bool AcceleratedLoop::close_enough(const State& y) const {
  const double error = estimate_.error(size_, anderson_.smallest_response());
  return part_ == 1 && error <= StageSystem::allowed_error(*stage_, guess_, y);
}

/// Whether the springs make A so stiff that its updates do not show how far off modes are in which the cloth is slack.
bool AcceleratedLoop::estimate_unreliable() const {
  return may_switch() && estimate_.mass_scaled_residual() > AutoPolicy::stiffest * size_;
}

bool AcceleratedLoop::stagnates() const {
  if (matrix_ == nullptr) return false;
  const bool old = !made_here_ && (since_renewal_ >= patience || (since_renewal_ > 2 && rate_ > slow_rate));
  return old || since_renewal_ > most_patience;
}

StageResult AcceleratedLoop::solve(const Stage& stage, State& y) {
  begin(stage, y);
  prescribe(ode_.pins, y.v);
  if (!find_matrix(y)) return result_;
  for (;;) {
    if (result_.updates >= options_.max_updates) return ended(Outcome::not_converged);
    system_.evaluate(stage, nullptr, y);
    system_.filter_residual(stage.gamma);
    estimate_.measure(system_.residual(), stage.gamma);
    if (result_.updates == 0) noise_ = system_.noise(y, stage.gamma);
    if (result_.updates > 0 && estimate_.residual() <= noise_) break;
    if (!correct()) return result_;
    ++result_.updates;
    ++work_.updates;
    ++since_renewal_;
    if (!(size_ <= (part_ < 1 ? 1 : growth) * best_)) {
      if (!backtrack(y)) return result_;
      if (searched_) break;
      continue;
    }
    advance(y);
    const bool close = close_enough(y);
    if (close && !estimate_unreliable()) break;
    if (may_switch() && (close || result_.updates >= AutoPolicy::most_constant_updates)) {
      if (!switch_to_newton(y)) return result_;
    } else if (stagnates()) {
      if (renewals_here_ < most_renewals ? !use_newton(matrix_, y) : !search(y)) return result_;
      if (searched_) break;
    }
  }
  y.x = stage.ax + stage.gamma * y.v;
  recycled_matrix_ = matrix_;
  recycled_gamma_ = system_.gamma();
  policy_.ended(result_.updates, renewals_here_);
  return ended(Outcome::success);
}

}  // namespace drape::solver
