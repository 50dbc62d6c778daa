#include "solver/integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "solver/global_error.hpp"
#include "solver/linear/counters.hpp"

namespace drape::solver {
namespace {

constexpr double same_step = 1e-9;  ///< relative difference of steps that is round-off, not intention

/// Part of the first step below which a run counts as stuck.
constexpr double smallest_step = 1e-6;

/// The same where steps are cut for their accuracy: where a pin jerks, steps are as short as its neighbours' motion.
constexpr double smallest_accurate_step = 1e-12;

/// Part of a step in which all kinks of forces are one: else where some are at the same time steps would end at each.
constexpr double same_kink = 1e-6;

/// Part of the kinetic energy that an impact must stop to be a hard one.
constexpr double hard_impact = 1e-2;

/// Part of the thickness that no step leaves less of.
constexpr double least_part = 0.1;

/// Tests the sum, which is finite only if all its terms are: unlike a test of each term, it is vectorised.
bool finite(const State& y, const Partition& all) { return !all.any(!std::isfinite(y.x.sum() + y.v.sum())); }

/// Whether v is farther from `one` than from `other`.
bool farther(const Vectors& v, const Vectors& one, const Vectors& other, const Partition& all) {
  std::array squares{(all.own(v) - all.own(one)).squaredNorm(), (all.own(v) - all.own(other)).squaredNorm()};
  all.add_up(squares);
  return squares[0] > squares[1];
}

double controlled(const StepControl& control, double h, int updates) {
  if (updates > control.max_updates) return h / control.factor;
  if (updates < control.min_updates) return h * control.factor;
  return h;
}

/// Number of points that the history keeps: those that the method needs, and one more than its order for guesses and error
/// estimates.
int history_points(const Method& method, const Options& options) {
  const bool estimates = (method.implicit() && options.stage->accelerated) || options.error_control.enabled();
  return std::max(method.history, estimates ? method.order + 1 : 0);
}

/// The initial point, with prescribed velocities set, and nothing remembered if it does not say what.
Point first_point(const SplitOde& ode, const Method& method, double t, State y) {
  prescribe(ode.pins, y.v);
  if (ode.memory && y.z.size() == 0) y.z.setZero(ode.memory->variables());
  return {t, std::move(y), method.forces > 0 ? Vectors::Zero(ode.particles(), 3) : Vectors(), false};
}

std::string describe(Outcome outcome, const StageResult& result, double t, double h) {
  return fmt::format("step from t = {:f} s with h = {:f} s: {} after {} updates and {} CG iterations", t, h, to_string(outcome),
                     result.updates, result.cg_iterations);
}

}  // namespace

Integrator::Integrator(const SplitOde& ode, const Method& method, const Options& options, State y0, double t0, Start start)
    : options_(options),
      method_(method),
      own_(ode.memory || ode.step_forces ? std::optional<SplitOde>(ode) : std::nullopt),
      history_(history_points(method, options), method.forces, first_point(ode, method, t0, std::move(y0))),
      next_(history_[0]),
      scratch_{Vectors::Zero(ode.particles(), 3), Vectors::Zero(ode.particles(), 3), Vectors::Zero(ode.particles(), 3), {}},
      sub_stepping_{.substeps = ode.work->counter("substeps", "explicit sub-steps inside the stability limit"),
                    .limits = ode.work->counter("stability_limits", "estimates of that limit, some tens of forces each")},
      step_{.ode = own_ ? *own_ : ode,
            .options = options_,
            .stage = nullptr,
            .contacts = nullptr,
            .linearised = nullptr,
            .phi = nullptr,
            .history = history_,
            .next = next_,
            .scratch = scratch_,
            .sub_stepping = sub_stepping_,
            .error = step_error_,
            .kept = kept_},
      extrapolates_(history_points(method, options) > std::min(method.history, 2)),
      tolerance_(options.error_control.tolerance),
      steps_(ode.work->counter("steps", "accepted steps")),
      rejected_(ode.work->counter("rejected_steps", "steps that failed and were not passed on")),
      starting_(ode.work->counter("starting_steps", "accepted steps by the method that starts this one")),
      kinks_(ode.work->counter("kinks", "steps that were taken again to end at a kink of a force")) {
  if (ode.contacts && !method.meets_obstacles)
    throw std::invalid_argument("method '" + std::string(method.name) +
                                "': expected a method that responds to obstacles, which this scene has");
  if (method.needs_energies && !ode.without_energy.empty())
    throw std::invalid_argument("method '" + std::string(method.name) + "': expected elastic forces with mean forces, not '" +
                                ode.without_energy.front() + "'");
  const LinearCounters registered(*ode.work);  // so that explicit methods record zeros
  if (ode.memory) {
    ode.memory->begin(method.order, t0, state());
    stiffness_changes_ = ode.memory->stiffness_changes();
    own_->stiffness = ode.memory->stiffness();
  }
  if (ode.pairs) separation_.emplace(step_.ode);
  if (method.implicit()) {
    if (ode.contacts || (ode.pairs && method.meets_obstacles)) step_.contacts = &contacts_.emplace(step_.ode);
    step_.stage = &stage_.emplace(step_.ode, options_, step_.contacts);
  } else if (ode.contacts) {
    sub_stepping_.impacts = &impacts_.emplace(step_.ode);
  }
  if (method.stages == Method::Stages::linearised) step_.linearised = &linearised_.emplace(step_.ode);
  if (method.stages == Method::Stages::exponential) step_.phi = &phi_.emplace(step_.ode);
  step_.after_impact = start == Start::jump;
  ode.work->counter("history_states", "states before the current one that the method keeps") = method.history - 1;
}

StageResult Integrator::step(double h) {
  bool hard = attempt(h);
  const double part = part_to_kink(same_kink * h);
  if (part < 1) hard = end_behind_kink(part);
  StageResult& result = step_.result;
  if (result.outcome != Outcome::success) {
    ++rejected_;
    return result;
  }
  ++steps_;
  starting_ += step_.starting ? 1 : 0;
  step_.after_impact = hard;
  sum_step_forces();
  finish_contacts();
  remember(step_.h, hard || part < 1);
  return result;
}

/// Everything of a step that may still be rejected. Returns whether it met an obstacle hard.
bool Integrator::attempt(double h) {
  step_.t = time();
  step_.h = h;
  if (history_.last_step() > 0) step_.after_impact = false;  // true if a rejected step was repeated without history
  step_.result = {};
  step_.starting = false;
  step_error_.embedded = false;
  step_error_.split_gamma = 0;
  next_.has_f = false;
  step_.recall();
  follow_stiffness();
  follow_step_forces();
  begin_contacts(h);
  method_.step(step_);
  for (Vectors* field : {&next_.y.x, &next_.y.v}) step_.ode.partition->set_copies(*field);
  bool hard = hit_hard();
  if (hard) step_without_history();
  StageResult& result = step_.result;
  if (result.outcome == Outcome::success && !finite(next_.y, *step_.ode.partition)) result.outcome = Outcome::not_finite;
  if (result.outcome == Outcome::success && step_.ode.relocate) hard = relocate() || hard;
  if (result.outcome == Outcome::success && separation_) separate();
  if (result.outcome == Outcome::success && !hard) {
    predict(h);
    error_ = estimate_error(h);
    if (error_ > 1) result.outcome = Outcome::inaccurate;
  }
  return hard;
}

/// Part of a successful step after which a force has a kink; 1 if none has, or if that is not asked for. `least`: kinks in so
/// short a time from the beginning belong to the step before [s].
double Integrator::part_to_kink(double least) const {
  if (!options_.ends_at_kinks || !step_.ode.memory || step_.result.outcome != Outcome::success) return 1;
  return step_.ode.memory->first_kink(step_.h, least / step_.h, state(), next_.y);
}

/// Takes the step again, to end behind the kink at this part of it, by not much: slopes are to be those behind. Where the step
/// was too long for its cubic to say where that is, shorter ones do.
bool Integrator::end_behind_kink(double part) {
  constexpr int most_attempts = 40;
  constexpr double precision = 1e-5, least_more = 1e-8, growth = 100;
  ++kinks_;
  bool hard = false;
  const double least = same_kink * step_.h;
  double before = least, behind = step_.h, h = part * behind, more = least_more;
  for (int attempts = 0; attempts < most_attempts; ++attempts) {
    hard = attempt_again(h);
    if (step_.result.outcome != Outcome::success) break;
    part = part_to_kink(least);
    if (part < 1 && h - std::max(before, part * h) < precision * h) break;
    (part < 1 ? behind : before) = h;
    const double guess = part < 1 ? part * h : (1 + more) * h, middle = std::sqrt(before * behind);
    if (part == 1) more *= growth;
    h = part < 1 ? (guess > before ? guess : middle) : std::min(guess, middle);
  }
  return hard;
}

/// In the place of another step, whose work is added.
bool Integrator::attempt_again(double h) {
  const StageResult other = step_.result;
  const bool hard = attempt(h);
  step_.result.updates += other.updates;
  step_.result.cg_iterations += other.cg_iterations;
  return hard;
}

/// The explicit forces of the history are those without K x: the K of now.
void Integrator::follow_stiffness() {
  if (!step_.ode.memory || own_->memory->stiffness_changes() == stiffness_changes_) return;
  stiffness_changes_ = own_->memory->stiffness_changes();
  const SparseMatrix less = own_->stiffness - own_->memory->stiffness();
  own_->stiffness = own_->memory->stiffness();
  if (method_.stages == Method::Stages::linear)
    for (int k = 0; k < method_.forces; ++k)
      if (history_[k].has_f) history_[k].f += less * history_[k].y.x;
  renew_matrices();
}

/// Forces of the history are those of steps before: methods that combine them need the forces of this step.
void Integrator::follow_step_forces() {
  const auto& forces = step_.ode.step_forces;
  if (!forces) return;
  forces->begin(step_.t, state());
  if (forces->changes() == force_changes_) return;
  force_changes_ = forces->changes();
  own_->stiffness = forces->stiffness();
  own_->damping = forces->damping();
  for (int k = 0; k < method_.forces; ++k) history_[k].has_f = false;
  renew_matrices();
}

/// The sum of these forces, without what pins bear [N].
Eigen::Vector3d Integrator::step_force(StepForces::Part part, double t, const State& y) {
  step_.ode.step_forces->of_obstacles(part, t, y, scratch_.f_hat);
  filter(step_.ode.pins, scratch_.f_hat);
  return scratch_.f_hat.colwise().sum();
}

/// Their impulse: as the method has it if it is one of Euler's, by the trapezoidal rule for what is more accurate.
void Integrator::sum_step_forces() {
  using enum StepForces::Part;
  if (!step_.ode.step_forces) return;
  const double begin = step_.t, end = step_.t + step_.h;
  const bool implicit_euler = method_.order == 1 && method_.implicit();
  if (!implicit_euler) {
    forced_ = step_.h / 2 * (step_force(whole, begin, state()) + step_force(whole, end, next_.y));
    return;
  }
  forced_ = step_.h * step_force(whole, end, next_.y);
  if (method_.stages == Method::Stages::linear)
    forced_ += step_.h * (step_force(without_linear, begin, state()) - step_force(without_linear, end, next_.y));
}

void Integrator::renew_matrices() {
  if (stage_) stage_->renew();
  kept_.reset();
  sub_stepping_.limit = 0;
}

void Integrator::begin_contacts(double h) {
  if (contacts_) contacts_->begin(step_.t, h, state());
  if (impacts_) impacts_->begin(step_.t, h, state());
}

/// The last word on whether the cloth meets itself: stages constrain pairs where their ways are linearised, and not all methods
/// have such stages.
void Integrator::separate() {
  const bool constrains = contacts_ && !method_.sub_steps;
  std::span<const Contact> possible;
  if (contacts_) possible = contacts_->possible();
  if (impacts_) possible = impacts_->possible();
  const Eigen::Vector3d before = next_.y.v.transpose() * step_.ode.mass;
  if (!separation_->separate(step_.t, state(), step_.h, {constrains ? least_part : 1, least_part}, possible, next_.y))
    step_.result.outcome = Outcome::not_converged;
  separated_.setZero();
  if (step_.ode.pins.empty()) separated_ = next_.y.v.transpose() * step_.ode.mass - before;
}

/// Whether the step met an obstacle so hard that the neighbours' velocities jump as well, which makes the history useless.
bool Integrator::hit_hard() const {
  return contacts_ && method_.history > 1 && step_.result.outcome == Outcome::success &&
         contacts_->stopped_energy() > hard_impact * kinetic_energy(step_.ode, state().v);
}

void Integrator::step_without_history() {
  step_.after_impact = true;
  contacts_->begin(step_.t, step_.h, state(), true);
  method_.step(step_);
}

/// Discards the force of the history's newest point if contacts changed its velocities. Sub-steps finish theirs.
void Integrator::finish_contacts() {
  if (contacts_ && !method_.sub_steps && contacts_->finish(next_.y, history_[0].y)) history_[0].has_f = false;
}

/// Lets obstacles change the end of the step. Returns whether it stopped more kinetic energy than a history bears.
bool Integrator::relocate() {
  relocated_ = {};
  State& y1 = next_.y;
  found_ = y1;
  if (!step_.ode.relocate(step_.t, step_.h, state(), y1)) return false;
  Vectors moved = y1.x - found_.x, change = y1.v - found_.v;
  filter(step_.ode.pins, moved);
  filter(step_.ode.pins, change);
  y1.x = found_.x + moved;
  y1.v = found_.v + change;
  next_.has_f = false;
  for (int i = 0; i < step_.ode.particles(); ++i)
    relocated_.constrained += moved.row(i).isZero(0) && change.row(i).isZero(0) ? 0 : 1;
  relocated_.impulse = change.transpose() * step_.ode.mass;
  relocated_.work = kinetic_energy(step_.ode, y1.v) - kinetic_energy(step_.ode, found_.v);
  return kinetic_energy(step_.ode, change) > hard_impact * kinetic_energy(step_.ode, found_.v);
}

/// Extrapolates the history to the end of the step: v into av, and x into ax if the error estimate needs it.
void Integrator::predict(double h) {
  if (!extrapolates_ || history_.smooth() < 2) return;
  const bool positions = options_.error_control.enabled() && !step_error_.embedded;
  history_.extrapolate(step_.t + h, scratch_.av, positions ? &scratch_.ax : nullptr);
}

/// Estimate of the local error over its tolerance: from the embedded method, or from the difference to the extrapolated history
/// (Milne's device). While the history is short that difference, which is of a lower order, stands for the error.
double Integrator::estimate_error(double h) {
  const ErrorControl& control = options_.error_control;
  if (!control.enabled()) return 0;
  State& error = step_error_.estimate;
  if (!step_error_.embedded) {
    if (history_.smooth() < 2) return 0;
    const double ratio = step_.error_over_extrapolation(step_.t + h);
    const double part = history_.full() ? ratio / (1 + ratio) : 1;
    error.x = part * (next_.y.x - scratch_.ax);
    error.v = part * (next_.y.v - scratch_.av);
    if (step_error_.split_gamma > 0) {
      error.x += step_error_.split_gamma * step_error_.split;
      error.v += step_error_.split;
    }
  }
  const double x = error.x.norm() / control.length, v = error.v.norm() * control.duration / control.length;
  return std::hypot(x, v) / (tolerance_ * std::sqrt(2 * 3 * step_.ode.particles()));
}

double Integrator::first_step() const {
  const ErrorControl& control = options_.error_control;
  const SplitOde& ode = step_.ode;
  Vectors a(ode.particles(), 3);
  ode.force(time(), state().x, state().v, a);
  filter(ode.pins, a);
  const double rms = (ode.mass.cwiseInverse().asDiagonal() * a).norm() / std::sqrt(ode.particles());
  const double time = rms > 0 ? std::sqrt(control.length / rms) : control.duration;
  return 0.1 * std::pow(tolerance_, 1.0 / (method_.order + 1)) * std::min(time, control.duration);
}

/// Adds the step to the history. The motion is not smooth where its extrapolation is worse than no change at all: later
/// extrapolations begin there.
void Integrator::remember(double h, bool restart) {
  const Vectors& v1 = next_.y.v;
  const bool rough = extrapolates_ && history_.smooth() > 1 && farther(v1, scratch_.av, state().v, *step_.ode.partition);
  if (step_.ode.memory) step_.ode.memory->carry(step_.t + h, next_.y);
  next_.t = end_of_step(h);
  history_.push(next_, h);
  if (restart) history_.restart();
  if (rough && history_.smooth() > 2) history_.begin_smooth();
}

ContactReport Integrator::contacts() const {
  ContactReport report;
  if (step_.ode.relocate)
    report = relocated_;
  else if (contacts_)
    report = {contacts_->constrained(), contacts_->impulse() + separated_, contacts_->work()};
  else if (impacts_)
    report = {impacts_->constrained(), impacts_->impulse() + separated_, impacts_->work()};
  report.impulse += forced_;
  return report;
}

/// Compensated summation: else the round-off of a million steps would reach the size of a step.
double Integrator::end_of_step(double h) {
  const double increment = h - lost_time_;
  const double t = step_.t + increment;
  lost_time_ = (t - step_.t) - increment;
  return t;
}

namespace {

/// The size of the steps of a run: constant, controlled by the number of updates, or by the error; cut where a step fails.
class StepSizes {
 public:
  StepSizes(const Integrator& integrator, double h)
      : control_(integrator.options().control),
        error_(integrator.options().error_control),
        first_(h),
        h_(h),
        order_(integrator.method().order) {
    may_cut_ = control_.enabled() || error_.enabled() || integrator.options().stage->accelerated;
    if (error_.enabled()) h_ = std::min(h, integrator.first_step());
  }

  double next(double left) const { return left < h_ * (1 - same_step) ? left : h_; }

  void accepted(double size, int updates, double error) {
    if (error_.enabled()) {
      const double factor = std::min(pi_factor(error), cut_ ? 1.0 : 2.0);  // a size just rejected is not tried again at once
      cut_ = false;
      before_ = std::max(error, 1e-3);
      if (factor < 1 || factor > worthwhile) h_ = std::min(first_, factor * size);
    } else if (control_.enabled()) {
      h_ = controlled(control_, h_, updates);
    } else {
      h_ = std::min(first_, 2 * size);
    }
  }

  /// Cuts the step; false if it is too small already.
  bool rejected(double size, Outcome outcome, double error) {
    const double smallest = outcome == Outcome::inaccurate ? smallest_accurate_step : smallest_step;
    if (!may_cut_ || size <= smallest * first_) return false;
    cut_ = true;
    if (outcome == Outcome::inaccurate)
      h_ = size * std::clamp(safety * std::pow(error, -1.0 / (order_ + 1)), 0.2, 0.9);
    else
      h_ = size / (control_.enabled() ? control_.factor : 2);
    return true;
  }

 private:
  static constexpr double safety = 0.9;
  static constexpr double worthwhile = 1.2;  ///< a smaller growth is not worth a new matrix

  /// PI controller, of the error and its change   [Gustafsson 1991].
  double pi_factor(double error) const {
    const double q = order_ + 1, now = std::max(error, 1e-3);
    return std::clamp(safety * std::pow(now, -0.7 / q) * std::pow(before_ / now, 0.4 / q), 0.3, 2.0);
  }

  const StepControl& control_;
  const ErrorControl& error_;
  double first_, h_, before_ = 1;
  int order_;
  bool may_cut_ = false, cut_ = false;
};

RunResult advance(Integrator& integrator, double t_end, double h, const Observer& observer) {
  const ErrorControl& control = integrator.options().error_control;
  StepSizes sizes(integrator, h);
  RunResult run;
  run.last_good_time = integrator.time();
  for (double left = t_end - integrator.time(); left > same_step * h; left = t_end - integrator.time()) {
    if (control.enabled() && run.steps + run.rejected_steps >= control.most_steps) {
      run.outcome = Outcome::inaccurate;
      run.message = fmt::format("more than {} steps, {} of them rejected, at t = {:g} s", control.most_steps,
                                run.rejected_steps, integrator.time());
      return run;
    }
    const double size = sizes.next(left);
    const StageResult result = integrator.step(size);
    if (result.outcome == Outcome::success) {
      ++run.steps;
      run.last_good_time = integrator.time();
      const double taken = integrator.last_step();
      if (observer)
        observer({integrator.time(), taken, result.updates, result.cg_iterations, integrator.state(), integrator.contacts()});
      if (taken == size) sizes.accepted(size, result.updates, integrator.error());  // what ends at a kink says nothing of sizes
      continue;
    }
    ++run.rejected_steps;
    if (sizes.rejected(size, result.outcome, integrator.error())) continue;
    run.outcome = result.outcome;
    run.message = describe(result.outcome, result, integrator.time(), size);
    return run;
  }
  return run;
}

}  // namespace

RunResult integrate(Integrator& integrator, double t_end, double h, const Observer& observer) {
  if (!(h > 0) || !std::isfinite(h)) throw std::invalid_argument("the step must be a positive number of seconds");
  const ErrorControl& control = integrator.options().error_control;
  if (!control.enabled() || !control.global) return advance(integrator, t_end, h, observer);
  const GlobalControl plan = plan_global_control(integrator, t_end, h);
  if (!plan.feasible) return {Outcome::inaccurate, plan.remark, integrator.time(), 0, 0};
  integrator.limit_error(plan.tolerance);
  RunResult run = advance(integrator, t_end, plan.largest_step, observer);
  if (run.message.empty()) run.message = plan.remark;
  return run;
}

}  // namespace drape::solver
