#include "bench/runs/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>

#include "bench/runs/contact_observer.hpp"
#include "bench/runs/energy_guard.hpp"
#include "bench/runs/trajectory_observer.hpp"
#include "model/at_rest.hpp"
#include "model/garment.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/threads.hpp"

namespace drape::bench {
namespace {

std::vector<results::Parameter> parameters(const RunSpec& spec, int particles) {
  const solver::Options& o = spec.options;
  std::vector<results::Parameter> all{
      {"size", model::size(spec.scene), "m", "length by which errors are divided"},
      {"threads", double(base::threads_for(particles)), "1", "that a sheet of this size may use"}};
  if (spec.method->implicit()) {
    all.push_back(
        {"cg_tolerance", o.cg_tolerance, "1", "residual of a linear solve over |b|; in the loop at most half of its"});
    all.push_back({"max_cg_iterations", double(o.max_cg_iterations), "1", "iterations a solve before it counts as failed"});
  }
  if (spec.method->sub_steps) all.push_back({"verlet_fraction", o.verlet_fraction, "1", "sub-step over its stability limit"});
  if (spec.method->repeats == solver::Method::Repeats::sub_steps_and_sweeps)
    all.push_back({"sub_steps", double(o.sub_steps), "1", "sub-steps a step"});
  if (spec.method->repeats != solver::Method::Repeats::none)
    all.push_back({"sweeps", double(o.sweeps), "1", "sweeps a sub-step, or a step if there are none"});
  if (spec.method->nonlinear()) {
    if (o.stage->accelerated)
      all.push_back({"stage_accuracy", o.stage_accuracy, "1", "error left in a stage over the error of the time step"});
    else if (o.accepted_passes() > 0)
      all.push_back({"passes", double(o.accepted_passes()), "1", "updates after which a stage counts as solved"});
    else if (o.stage->iteration != solver::StageKind::Iteration::printed_loop)  // it has CG's tolerance only
      all.push_back({"loop_tolerance", o.loop_tolerance, "1", "residual of the fixed-point loop over |b|"});
    if (o.stage->iteration == solver::StageKind::Iteration::chebyshev)
      all.push_back({"chebyshev_radius", o.chebyshev_radius, "1", "spectral radius that is assumed of the loop"});
    all.push_back({"max_updates", double(o.max_updates), "1", "updates a stage before it counts as failed"});
  }
  if (o.error_control.enabled())
    all.push_back({"tolerance", o.error_control.tolerance, "1",
                   o.error_control.global ? "of the largest error at the tenths of the run, over the size"
                                          : "of the local error, over the size"});
  if (o.ends_at_kinks) all.push_back({"events", 1, "1", "steps end at kinks of forces"});
  if (o.control.enabled()) {
    all.push_back({"control_min_updates", double(o.control.min_updates), "1", "the step grows after fewer updates"});
    all.push_back({"control_max_updates", double(o.control.max_updates), "1", "the step shrinks after more updates"});
    all.push_back({"control_factor", o.control.factor, "1", "by which the step grows and shrinks"});
  }
  return all;
}

std::string_view stage_solver(const RunSpec& spec) {
  switch (spec.method->stages) {
    case solver::Method::Stages::none: return "none";
    case solver::Method::Stages::linear: return "linear";
    case solver::Method::Stages::linearised: return "linearised";
    case solver::Method::Stages::own: return "own";
    case solver::Method::Stages::exponential: return "exponential";
    case solver::Method::Stages::nonlinear: break;
  }
  return spec.options.stage->name;
}

/// What is known of a run before it begins, except its plan.
results::RunRecord describe(const RunSpec& spec) {
  results::RunRecord run;
  run.scene = spec.scene.name;
  run.scene_toml = model::to_toml(spec.scene);
  for (const model::KeyValue& row : model::key_values(spec.scene))
    run.scene_keys.push_back({row.key, model::to_toml(row.value), row.unit});
  run.overrides = spec.overrides;
  run.method = spec.method_name();
  run.stage_solver = stage_solver(spec);
  run.linear_solver = spec.method->implicit() ? spec.options.linear_solver->name : "none";
  run.step = spec.step;
  run.until = spec.scene.end;
  run.choice = spec.choice;
  run.parameters = parameters(spec, model::nodes(spec.scene));
  run.numerical_stiffness = model::numerical_stiffness(spec.scene, spec.step);
  run.stiffness_to_damping = model::stiffness_to_damping(spec.scene, spec.step);
  return run;
}

/// Steps with their energies.
class StepRecorder : public Observer {
 public:
  explicit StepRecorder(std::vector<results::StepRecord>& steps) : steps_(steps) {}

  void begin(const model::Scene&, const model::Cloth& cloth, const solver::State&) override { ode_ = &cloth.ode; }
  void observe(const solver::StepReport& step) override {
    steps_.push_back({step.t, step.h, step.updates, step.cg_iterations, solver::kinetic_energy(*ode_, step.y.v),
                      solver::stored_energy(*ode_, step.t, step.y), step.contacts.constrained});
  }

 private:
  std::vector<results::StepRecord>& steps_;
  const solver::SplitOde* ode_ = nullptr;
};

}  // namespace

results::RunRecord record(const RunSpec& spec, std::span<Observer* const> observers, Limits limits) {
  limits.interruptible_steps = true;
  results::RunRecord record = describe(spec);
  EnergyGuardObserver guard;
  StepRecorder steps(record.steps);
  ContactObserver contact;
  std::vector<Observer*> all{&guard, &steps, &contact};
  all.insert(all.end(), observers.begin(), observers.end());
  std::optional<model::Cloth> cloth;
  RunEnd end = run(spec, cloth, all, limits);
  record.outcome = end.result.outcome;
  record.message = std::move(end.result.message);
  if (record.message.empty() && model::is_at_rest(spec.scene)) record.message = model::at_rest_remark;
  record.last_good_time = end.result.last_good_time;
  record.contact = contact.result();
  if (!cloth) return record;
  record.plan = model::to_string(cloth->plan);
  record.final_state = std::move(end.state);
  for (const auto& [name, description, count] : cloth->ode.work->kinds()) record.work.push_back({name, description, count});
  return record;
}

}  // namespace drape::bench
