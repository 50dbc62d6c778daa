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
constexpr int patience = 6;               ///< or after so many updates,
constexpr int most_patience = 12;         ///< even if it was made for this stage,
constexpr double different_gamma = 0.25;  ///< or for a γ so far away
constexpr int most_constant_updates = 150;  ///< what a stage costs with Newton's matrix where it is hard
constexpr double similar_gamma = 0.1;       ///< the constant matrix serves for a γ as near as this
constexpr int most_renewals = 4;            ///< of a matrix in a stage; then every update needs one
constexpr int update_cost = 4;              ///< of an update with a Newton matrix, in updates with the constant matrix
constexpr int renewal_cost = 40;            ///< of making it
constexpr int longest_stay = 64;            ///< stages after which `auto` tries the constant matrix again
constexpr double cheap = 50;                ///< cost of a stage for which the constant matrix need not be tried
constexpr double mean_weight = 0.2;         ///< of the second estimate of the error
constexpr double reduction_memory = 0.5;    ///< part of the reduction seen before that is the least to be expected
constexpr double regular = 0.3;             ///< reduction from which on convergence is too irregular to be counted on
constexpr double reduction_ages = 1.3;      ///< how much less is expected of it in each further stage
constexpr double sudden = 1.2;              ///< growth of the first |d| from stage to stage from which on nothing is expected
constexpr double stiffest = 1e4;            ///< A over A without springs, beyond which `auto` does not trust it

}  // namespace

AcceleratedLoop::AcceleratedLoop(const SplitOde& ode, const Options& options, StageSystem& system)
    : ode_(ode),
      options_(options),
      system_(system),
      mass_(thrice(ode.mass)),
      drag_(ode.damping.nonZeros() > 0 ? thrice(ode.damping.diagonal()) : Eigen::VectorXd::Zero(mass_.size())),
      inverse_mass_(mass_.inverse()),
      anderson_(ode.particles()),
      newton_(ode, options, system, false),
      lean_newton_(ode, options, system, true),
      search_(ode, options, system),
      work_(*ode.work),
      escalations_(ode.work->counter("escalations", "stages that auto gave to Newton's matrix")) {
  const bool newton = options.stage->matrix == Matrix::newton || options.stage->matrix == Matrix::lean_newton;
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
    case Matrix::lean_newton: return &lean_newton_;
    case Matrix::chosen: return newton_stages_ > 0 ? &lean_newton_ : nullptr;
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
  best_ = last_ = infinity;
  part_ = 1;
  rate_ = 0;
  since_renewal_ = 0;
  made_here_ = true;
}

/// With another P the iteration is another one.
void AcceleratedLoop::forget() {
  start_iteration();
  reduction_ = 1;
  anderson_.restart();
}

/// Takes over what the stage before has learnt of the iteration, if it was the same.
void AcceleratedLoop::recycle() {
  if (matrix_ == recycled_matrix_ && system_.gamma() == recycled_gamma_) {
    reduction_ = std::min(1.0, reduction_ages * reduction_);
    anderson_.begin();
  } else {
    reduction_ = 1;
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
  forget();
  y.x = stage_->ax + stage_->gamma * y.v;
  ++renewals_here_;
  result_.outcome = matrix->renew(stage_->t, y, stage_->gamma);
  return result_.outcome == Outcome::success;
}

/// Finds the norms of r in one pass.
void AcceleratedLoop::measure() {
  if (unsprung_gamma_ != stage_->gamma) {
    unsprung_gamma_ = stage_->gamma;
    unsprung_inverse_ = (mass_ - unsprung_gamma_ * drag_).inverse();
  }
  const double *const r = system_.residual().data(), *const m = inverse_mass_.data(), *const u = unsprung_inverse_.data();
  const Eigen::Index n = system_.residual().size();
  double plain = 0, by_mass = 0, unsprung = 0;
#pragma omp simd reduction(+ : plain, by_mass, unsprung)
  for (Eigen::Index i = 0; i < n; ++i) {
    plain += r[i] * r[i];
    by_mass += (m[i] * r[i]) * (m[i] * r[i]);
    unsprung += (u[i] * r[i]) * (u[i] * r[i]);
  }
  residual_ = std::sqrt(plain);
  bound_ = std::sqrt(by_mass);
  unsprung_ = std::sqrt(unsprung);
}

/// d = P⁻¹ r; false if the solve fails.
bool AcceleratedLoop::correct() {
  const Vectors& r = system_.residual();
  size_ = infinity;
  if (!std::isfinite(residual_)) return true;
  const LinearResult solved =
      matrix_ != nullptr ? matrix_->solve(r, system_.correction()) : system_.correct(forcing * residual_);
  result_.cg_iterations += solved.iterations;
  if (solved.outcome != Outcome::success) {
    result_.outcome = solved.outcome;
    return false;
  }
  size_ = system_.correction().norm();
  return true;
}

/// Back to the best iterate; false if there is no way on from there.
bool AcceleratedLoop::retreat(State& y) {
  if (!std::isfinite(best_)) {
    result_.outcome = Outcome::not_finite;
    return false;
  }
  y.v = best_v_;
  if (matrix_ != nullptr) return made_here_ ? search(y) : use_newton(matrix_, y);
  anderson_.restart();
  part_ /= 4;
  rate_ = 0;
  if (part_ < smallest_part) return escalate(y);
  y.v += part_ * best_d_;
  return true;
}

/// The rest of the stage by Newton's method with line searches; false if that fails, too.
bool AcceleratedLoop::search(State& y) {
  const int updates = result_.updates;
  search_.solve(*stage_, guess_, newton_, y, result_);
  renewals_here_ += result_.updates - updates;
  searched_ = true;
  return result_.outcome == Outcome::success;
}

bool AcceleratedLoop::may_escalate() const {
  return options_.stage->matrix == Matrix::chosen && ode_.newton_matrix && matrix_ == nullptr;
}

/// On with Newton's matrix where `auto` may; not converged otherwise.
bool AcceleratedLoop::escalate(State& y) {
  if (!may_escalate()) {
    result_.outcome = Outcome::not_converged;
    return false;
  }
  ++escalations_;
  newton_stages_ = next_stay_;
  mean_cost_ = most_constant_updates;
  next_stay_ = std::min(2 * next_stay_, longest_stay);
  y.v = best_v_;
  return use_newton(&lean_newton_, y);
}

/// What an update reduces |d| by, as far as it has been seen; nothing where convergence is slow, or where a stage begins
/// farther off than the one before.
void AcceleratedLoop::expect() {
  if (std::isfinite(last_)) {
    const double seen = size_ / last_;
    reduction_ = seen > regular ? 1 : std::max(seen, reduction_memory * reduction_);
  } else {
    if (size_ > sudden * first_) reduction_ = 1;
    first_ = size_;
  }
  last_ = size_;
}

void AcceleratedLoop::advance(State& y) {
  expect();
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

/// The estimates are of the error before the update; what was seen of updates tells what they leave of it   [as in CVODE].
bool AcceleratedLoop::close_enough(const State& y) const {
  const double error = reduction_ * std::max(size_ / anderson_.weakest(), mean_weight * std::sqrt(bound_ * size_));
  return part_ == 1 && error <= StageSystem::allowed_error(*stage_, guess_, y);
}

/// Whether the springs make A so stiff that its updates do not show how far off modes are in which the cloth is slack.
bool AcceleratedLoop::blind() const { return may_escalate() && unsprung_ > stiffest * size_; }

bool AcceleratedLoop::slow() const {
  if (matrix_ == nullptr) return false;
  const bool old = !made_here_ && (since_renewal_ >= patience || (since_renewal_ > 2 && rate_ > slow_rate));
  return old || since_renewal_ > most_patience;
}

/// `auto` stays with Newton's matrix for some stages, and longer where these were cheap.
void AcceleratedLoop::plan_next() {
  if (newton_stages_ == 0) return;
  const int cost = update_cost * result_.updates + renewal_cost * renewals_here_;
  mean_cost_ += 0.2 * (cost - mean_cost_);
  if (--newton_stages_ == 0 && mean_cost_ < cheap) newton_stages_ = next_stay_;
}

StageResult AcceleratedLoop::solve(const Stage& stage, State& y) {
  begin(stage, y);
  prescribe(ode_.pins, y.v);
  if (!find_matrix(y)) return result_;
  for (;;) {
    if (result_.updates >= options_.max_updates) return ended(Outcome::not_converged);
    system_.evaluate(stage, nullptr, y);
    system_.filter_residual(stage.gamma);
    measure();
    if (result_.updates == 0) noise_ = system_.noise(y, stage.gamma);
    if (result_.updates > 0 && residual_ <= noise_) break;
    if (!correct()) return result_;
    ++result_.updates;
    ++work_.updates;
    ++since_renewal_;
    if (!(size_ <= (part_ < 1 ? 1 : growth) * best_)) {
      if (!retreat(y)) return result_;
      if (searched_) break;
      continue;
    }
    advance(y);
    const bool close = close_enough(y);
    if (close && !blind()) break;
    if (may_escalate() && (close || result_.updates >= most_constant_updates)) {
      if (!escalate(y)) return result_;
    } else if (slow()) {
      if (renewals_here_ < most_renewals ? !use_newton(matrix_, y) : !search(y)) return result_;
      if (searched_) break;
    }
  }
  y.x = stage.ax + stage.gamma * y.v;
  recycled_matrix_ = matrix_;
  recycled_gamma_ = system_.gamma();
  plan_next();
  return ended(Outcome::success);
}

}  // namespace drape::solver
