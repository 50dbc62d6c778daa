#include "bench/runs/run.hpp"

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
#include "model/scene_file/scene_file.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/threads.hpp"

namespace drape::bench {
namespace {

std::vector<results::Parameter> parameters(const Cell& cell, int particles) {
  const solver::Options& o = cell.options;
  std::vector<results::Parameter> all{{"size", model::size(cell.scene), "m", "length by which errors are divided"}};
  if (cell.method->implicit()) {
    all.push_back(
        {"cg_tolerance", o.cg_tolerance, "1", "residual of a linear solve over |b|; in the loop at most half of its"});
    all.push_back(
        {"threads", double(base::threads_for(particles)), "1", "that the linear algebra of a sheet of this size may use"});
    all.push_back({"max_cg_iterations", double(o.max_cg_iterations), "1", "iterations a solve before it counts as failed"});
  } else if (cell.method->sub_steps) {
    all.push_back({"verlet_fraction", o.verlet_fraction, "1", "sub-step over its stability limit"});
  }
  if (cell.method->nonlinear()) {
    if (o.stage->accelerated)
      all.push_back({"stage_accuracy", o.stage_accuracy, "1", "error left in a stage over the error of the time step"});
    else
      all.push_back({"loop_tolerance", o.loop_tolerance, "1", "residual of the fixed-point loop over |b|"});
    all.push_back({"max_updates", double(o.max_updates), "1", "updates a stage before it counts as failed"});
  }
  if (o.error_control.enabled())
    all.push_back({"tolerance", o.error_control.tolerance, "1",
                   o.error_control.global ? "of the largest error at the tenths of the run, over the size"
                                          : "of the local error, over the size"});
  if (o.control.enabled()) {
    all.push_back({"control_min_updates", double(o.control.min_updates), "1", "the step grows after fewer updates"});
    all.push_back({"control_max_updates", double(o.control.max_updates), "1", "the step shrinks after more updates"});
    all.push_back({"control_factor", o.control.factor, "1", "by which the step grows and shrinks"});
  }
  return all;
}

std::string_view stage_solver(const Cell& cell) {
  switch (cell.method->stages) {
    case solver::Method::Stages::none: return "none";
    case solver::Method::Stages::linear: return "linear";
    case solver::Method::Stages::nonlinear: break;
  }
  return cell.options.stage->name;
}

std::string expected(const solver::Method& method) {
  using Stages = solver::Method::Stages;
  if (method.stages == Stages::none) return fmt::format("{}, it leaves no solver to choose", method.name);
  if (method.stages == Stages::linear) return fmt::format("{}/LINEAR_SOLVER, its stages are linear", method.name);
  return fmt::format("{}/STAGE_SOLVER/LINEAR_SOLVER", method.name);
}

template <class Row>
bool knows(std::span<const Row> table, std::string_view name) {
  return std::ranges::find(table, name, &Row::name) != table.end();
}

/// What is known of a run before it begins, but for its plan.
results::RunRecord describe(const Cell& cell) {
  results::RunRecord run;
  run.scene = cell.scene.name;
  run.scene_toml = model::to_toml(cell.scene);
  run.overrides = cell.overrides;
  run.method = cell.method_name();
  run.stage_solver = stage_solver(cell);
  run.linear_solver = cell.method->implicit() ? cell.options.linear_solver->name : "none";
  run.step = cell.step;
  run.until = cell.scene.end;
  run.parameters = parameters(cell, cell.scene.sheet.grid.particles());
  run.numerical_stiffness = model::numerical_stiffness(cell.scene, cell.step);
  run.stiffness_to_damping = model::stiffness_to_damping(cell.scene, cell.step);
  return run;
}

/// solver::integrate under the guard. An exception that the method throws is how its run ends.
solver::RunResult integrate(solver::Integrator& integrator, EnergyGuard& guard, const Cell& cell, const solver::Observer& see) {
  try {
    return integrate(integrator, guard, cell.scene.end, cell.step, see);
  } catch (const OutOfTime&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return {.outcome = solver::Outcome::failed, .message = error.what(), .last_good_time = integrator.time()};
  }
}

/// Takes a run as far as its limits allow.
template <class Go>
void go_within(const Limits& limits, results::RunRecord& run, const Go& go) {
  const auto stop = [&run](const char* outcome, std::string message) {
    run.outcome = outcome;
    run.message = std::move(message);
    run.last_good_time = run.steps.empty() ? 0 : run.steps.back().t;
  };
  try {
    const MemoryLimit memory(limits.megabytes);
    go();
  } catch (const OutOfTime& error) {
    stop(out_of_time, error.what());
  } catch (const std::bad_alloc&) {
    stop(out_of_memory,
         std::isfinite(limits.megabytes) ? fmt::format("more than {:g} MB", limits.megabytes) : "more than the machine has");
  }
}

}  // namespace

std::string Cell::method_name() const {
  std::string name(method->name);
  if (method->nonlinear() && options.stage != &solver::stage_kinds().front()) name += fmt::format("/{}", options.stage->name);
  if (method->implicit() && options.linear_solver != &solver::linear_solvers().front())
    name += fmt::format("/{}", options.linear_solver->name);
  return name;
}

void choose_method(Cell& cell, const std::string& name) {
  std::vector<std::string> parts;
  std::istringstream stream(name);
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  const std::string first = parts.empty() ? name : parts.front();
  cell.method = &solver::method(first);
  const solver::Method& method = *cell.method;
  std::size_t next = 1;
  if (next < parts.size() && method.nonlinear() && knows(solver::stage_kinds(), parts[next]))
    cell.options.stage = &solver::stage_kind(parts[next++]);
  if (next < parts.size() && method.implicit()) cell.options.linear_solver = &solver::linear_solver(parts[next++]);
  if (next < parts.size() || name.ends_with('/'))
    throw std::invalid_argument(fmt::format("method '{}': expected {}", base::quoted(name), expected(method)));
}

results::RunRecord record(const Cell& cell, const solver::Observer& look, std::optional<double> frames_every,
                          const Limits& limits) {
  results::RunRecord run = describe(cell);
  std::optional<model::Cloth> cloth;
  std::optional<ContactWatch> contact;
  std::optional<TrajectoryWatch> frames;
  std::optional<solver::Integrator> integrator;
  go_within(limits, run, [&] {
    cloth = model::compile(cell.scene);
    watch(cloth->ode, limits.seconds);
    const solver::SplitOde& ode = cloth->ode;
    run.plan = model::to_string(cloth->plan);
    integrator.emplace(ode, *cell.method, cell.options, cloth->start);
    if (look) look({0, 0, 0, 0, integrator->state(), {}});
    contact.emplace(cell.scene, *cloth);
    contact->see(0, cloth->start, solver::kinetic_energy(ode, cloth->start.v), ode.potential_energy(0, cloth->start.x));
    if (frames_every) frames.emplace(cell.scene, *cloth, *frames_every);
    EnergyGuard guard(cell.scene, *cloth);
    const auto see = [&](const solver::StepReport& step) {
      const double kinetic = solver::kinetic_energy(ode, step.y.v), potential = ode.potential_energy(step.t, step.y.x);
      run.steps.push_back({step.t, step.h, step.updates, step.cg_iterations, kinetic, potential, step.contacts.constrained});
      contact->see(step.t, step.y, kinetic, potential);
      if (frames) frames->see(step.t, step.y);
      if (look) look(step);
    };
    const solver::RunResult result = integrate(*integrator, guard, cell, see);
    run.outcome = to_string(result.outcome);
    run.message = result.message;
    if (run.message.empty() && model::is_at_rest(cell.scene)) run.message = model::at_rest_remark;
    run.last_good_time = result.last_good_time;
  });
  if (contact) run.contact = contact->result();
  if (frames) run.trajectory = frames->result();
  if (integrator) run.final_state = integrator->state();
  if (cloth)
    for (const auto& [name, description, count] : cloth->ode.work->kinds()) run.work.push_back({name, description, count});
  return run;
}

}  // namespace drape::bench
