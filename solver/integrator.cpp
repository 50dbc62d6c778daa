#include "solver/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "solver/linear_work.hpp"

namespace drape::solver {
namespace {

constexpr double same_step = 1e-9;  ///< relative difference of steps that is round-off, not intention

/// Below this part of the first step a run counts as stuck.
constexpr double smallest_step = 1e-6;

/// Part of the kinetic energy that an impact must stop to be a hard one.
constexpr double hard_impact = 1e-2;

/// A sum is finite only if all its terms are, and it is vectorised where a test of each would not be.
bool finite(const State& y) { return std::isfinite(y.x.sum() + y.v.sum()); }

double controlled(const StepControl& control, double h, int updates) {
  if (updates > control.max_updates) return h / control.factor;
  if (updates < control.min_updates) return h * control.factor;
  return h;
}

std::string describe(Outcome outcome, const StageResult& result, double t, double h) {
  return "step from t = " + std::to_string(t) + " s with h = " + std::to_string(h) + " s: " + std::string(to_string(outcome)) +
         " after " + std::to_string(result.updates) + " updates and " + std::to_string(result.cg_iterations) + " CG iterations";
}

}  // namespace

Integrator::Integrator(const SplitOde& ode, const Method& method, const Options& options, State y0, double t0)
    : options_(options),
      method_(method),
      step_{.ode = ode,
            .options = options_,
            .stage = nullptr,
            .t = t0,
            .before = {},
            .now = {},
            .next = {},
            .ax = Vectors::Zero(ode.particles(), 3),
            .av = Vectors::Zero(ode.particles(), 3),
            .f_hat = Vectors::Zero(ode.particles(), 3),
            .substeps = ode.work->counter("substeps", "explicit sub-steps inside the stability limit"),
            .result = {}},
      steps_(ode.work->counter("steps", "accepted steps")),
      rejected_(ode.work->counter("rejected_steps", "steps that failed and were not passed on")) {
  const LinearWork registered(*ode.work);  // so that explicit methods record zeros
  if (method.implicit()) {
    ContactResponse* const contacts = ode.contacts ? &contacts_.emplace(ode) : nullptr;
    step_.stage = &stage_.emplace(ode, options_, contacts);
  } else if (ode.contacts) {
    step_.impacts = &impacts_.emplace(ode);
  }

  prescribe(ode.pins, y0.v);
  const Vectors force = method.keeps_force ? Vectors::Zero(ode.particles(), 3) : Vectors();
  step_.now = step_.next = {y0, force, false};
  if (method.two_step) step_.before = step_.next;
  ode.work->counter("history_states", "states before the current one that the method keeps") = method.two_step ? 1 : 0;
}

StageResult Integrator::step(double h) {
  step_.h = h;
  step_.w = method_.two_step && h_before_ > 0 ? h / h_before_ : 0;
  step_.next.has_f = false;
  step_.result = {};
  begin_contacts(h);
  method_.step(step_);
  const bool hard = hit_hard();
  if (hard) step_without_history();
  StageResult& result = step_.result;
  if (result.outcome == Outcome::success && !finite(step_.next.y)) result.outcome = Outcome::not_finite;
  if (result.outcome != Outcome::success) {
    ++rejected_;
    return result;
  }
  ++steps_;
  h_before_ = hard ? 0 : h;
  step_.after_impact = hard;
  finish_contacts();
  if (method_.two_step) std::swap(step_.before, step_.now);
  std::swap(step_.now, step_.next);
  advance_time(h);
  return result;
}

void Integrator::begin_contacts(double h) {
  if (contacts_) contacts_->begin(step_.t, h, step_.now.y);
  if (impacts_) impacts_->begin(step_.t, h, step_.now.y);
}

/// Whether the step met an obstacle so hard that the neighbours' velocities jump too: there a history leads astray.
bool Integrator::hit_hard() const {
  return contacts_ && method_.two_step && step_.result.outcome == Outcome::success &&
         contacts_->stopped_energy() > hard_impact * kinetic_energy(step_.ode, step_.now.y.v);
}

void Integrator::step_without_history() {
  step_.w = 0;
  step_.after_impact = true;
  contacts_->begin(step_.t, step_.h, step_.now.y, true);
  method_.step(step_);
}

/// Where velocities were changed in the history, forces must be found anew.
void Integrator::finish_contacts() {
  if (contacts_ && contacts_->finish(step_.next.y, step_.now.y)) step_.now.has_f = false;
}

ContactReport Integrator::contacts() const {
  if (contacts_) return {contacts_->constrained(), contacts_->impulse()};
  if (impacts_) return {impacts_->constrained(), impacts_->impulse()};
  return {};
}

/// Compensated, or the round-off of a million steps would be a part of a step.
void Integrator::advance_time(double h) {
  const double increment = h - lost_time_;
  const double t = step_.t + increment;
  lost_time_ = (t - step_.t) - increment;
  step_.t = t;
}

RunResult integrate(Integrator& integrator, double t_end, double h, const Observer& observer) {
  if (!(h > 0) || !std::isfinite(h)) throw std::invalid_argument("the step must be a positive number of seconds");
  const StepControl& control = integrator.options().control;
  const double h_first = h;
  RunResult run;
  run.last_good_time = integrator.time();
  for (double left = t_end - integrator.time(); left > same_step * h; left = t_end - integrator.time()) {
    const double size = left < h * (1 - same_step) ? left : h;
    const StageResult result = integrator.step(size);
    if (result.outcome == Outcome::success) {
      ++run.steps;
      run.last_good_time = integrator.time();
      if (observer)
        observer({integrator.time(), size, result.updates, result.cg_iterations, integrator.state(), integrator.contacts()});
      if (control.enabled()) h = controlled(control, h, result.updates);
      continue;
    }
    ++run.rejected_steps;
    if (control.enabled() && size > smallest_step * h_first) {
      h = size / control.factor;
      continue;
    }
    run.outcome = result.outcome;
    run.message = describe(result.outcome, result, integrator.time(), size);
    return run;
  }
  return run;
}

}  // namespace drape::solver
