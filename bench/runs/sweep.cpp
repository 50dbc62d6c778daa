#include "bench/runs/sweep.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/contact_observer.hpp"
#include "bench/runs/identity.hpp"
#include "bench/runs/motion_error.hpp"
#include "bench/runs/record.hpp"
#include "bench/runs/reference_reports.hpp"
#include "bench/runs/samples.hpp"
#include "bench/runs/timing.hpp"
#include "bench/runs/trajectory_observer.hpp"
#include "model/phases.hpp"
#include "results/file/xdmf.hpp"
#include "solver/base/hash.hpp"
#include "solver/base/largest.hpp"

namespace drape::bench {
namespace {

std::string title(const RunSpec& spec) {
  return fmt::format("{} {} h = {} {}", spec.scene.name, spec.method_name(), spec.step, spec.overrides);
}

/// A run with its states at the compared times, which its error is found from when the reference is there.
struct MeasuredRun {
  results::RunRecord run;
  std::vector<solver::Vectors> positions, velocities;  ///< none if nothing is compared

  std::vector<solver::State> states() const {
    std::vector<solver::State> all;
    for (std::size_t k = 0; k < positions.size(); ++k) all.push_back({positions[k], velocities[k]});
    return all;
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MeasuredRun, run, positions, velocities)

/// The times of repetitions [ms] of a run, and the steps that each took.
struct TimedRun {
  std::vector<double> times;
  std::int64_t steps = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TimedRun, times, steps)

MeasuredRun measure(const RunSpec& spec, const SweepOptions& options) {
  std::vector<Observer*> observers;
  std::optional<Samples> samples;
  std::optional<TrajectoryObserver> trajectory;
  std::unique_ptr<Observer> other;
  if (options.reference && model::phases(spec.scene).size() == 1)
    observers.push_back(&samples.emplace(compared_times(spec.scene)));
  if (options.frames_every) observers.push_back(&trajectory.emplace(*options.frames_every));
  if (options.observer_for) observers.push_back((other = options.observer_for(spec)).get());
  MeasuredRun measured{record(spec, observers, options.limits), {}, {}};
  if (trajectory) measured.run.trajectory = trajectory->result();
  if (!samples || measured.run.outcome != solver::Outcome::success) return measured;
  for (const solver::State& y : samples->states()) {
    measured.positions.push_back(y.x);
    measured.velocities.push_back(y.v);
  }
  return measured;
}

void compare(MeasuredRun& measured, const reference::Reference& reference, const model::Scene& scene,
             const model::Cloth& cloth) {
  results::RunRecord& run = measured.run;
  run.error = distance(run, reference, scene, cloth);
  run.motion_error = motion_error(measured.states(), reference, scene, cloth);
  const reference::Trajectory& truth = reference.trajectory;
  if (run.contact) run.contact->reference_area = contact_area(scene, cloth, truth.times.back(), truth.states.back().x);
}

/// Compares all runs that succeeded; returns the smallest of their errors, over the size.
double compare_all(std::vector<MeasuredRun>& runs, const reference::Reference& reference, const model::Scene& scene,
                   const model::Cloth& cloth) {
  double smallest = std::numeric_limits<double>::infinity();
  for (MeasuredRun& measured : runs) {
    if (measured.run.outcome != solver::Outcome::success) continue;
    compare(measured, reference, scene, cloth);
    smallest = std::min(smallest, measured.run.error->rms);
  }
  return smallest;
}

/// Measures the runs of a group by the reference of their common scene, which is as tight as the smallest error needs, or says
/// with each why there is none.
void measure_errors(const model::Scene& scene, std::vector<MeasuredRun>& runs, References& references) {
  const auto remark = [&](const char* why) {
    for (MeasuredRun& measured : runs)
      measured.run.message += fmt::format("{}no reference: {}", measured.run.message.empty() ? "" : "; ", why);
  };
  try {
    const model::Cloth cloth = model::compile(scene);
    const reference::Reference first = references(scene, cloth);
    const double smallest = compare_all(runs, first, scene, cloth);
    if (cloth.ode.has_contacts() || 10 * base::largest(first.error) <= smallest * model::size(scene)) return;
    compare_all(runs, references.resolving(scene, cloth, smallest), scene, cloth);
  } catch (const reference::ReferenceError& error) {
    remark(error.what());
  } catch (const std::bad_alloc&) {
    remark("it needs more memory than the machine has");
  }
}

/// Before anything is computed.
void require_trajectories(const std::vector<Group>& groups, const SweepOptions& options) {
  for (const Group& group : groups) check_frames("--trajectory", *options.frames_every, group.front().scene.end);
  if (options.start == results::Start::fresh) base::require_creatable(results::xdmf_path(options.out));
}

/// Times those runs of a group that have kept their limits, as far as they went; the others have no times.
std::vector<TimedRun> time_all(const Group& group, int repetitions, const std::vector<MeasuredRun>& runs,
                               Checkpoint& checkpoint) {
  Group timed;
  std::vector<std::size_t> places, most_steps, steps;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const results::RunRecord& run = runs[k].run;
    if (run.outcome == solver::Outcome::out_of_time || run.outcome == solver::Outcome::out_of_memory) continue;
    timed.push_back(group[k]);
    most_steps.push_back(steps_to_time(run));
    places.push_back(k);
  }
  auto times = time_group(
      timed, most_steps, repetitions, [&] { checkpoint.advance(); }, &steps);
  std::vector<TimedRun> all(group.size());
  for (std::size_t k = 0; k < timed.size(); ++k) all[places[k]] = {std::move(times[k]), static_cast<std::int64_t>(steps[k])};
  return all;
}

/// What is known of a run before its error is.
std::string preview(const results::RunRecord& run) {
  std::string line = fmt::format("{} {} h = {}: {}", run.scene, run.method, run.step, to_string(run.outcome));
  if (!run.times_ms.empty()) line += fmt::format(", {:.4g} ms", std::ranges::min(run.times_ms));
  return line + "; its error follows";
}

/// What the reference says of a run.
struct ComparedRun {
  std::optional<results::ErrorRecord> error;
  std::optional<results::MotionErrorRecord> motion_error;
  std::optional<double> reference_area;
  std::string message;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ComparedRun, error, motion_error, reference_area, message)

ComparedRun compared(const results::RunRecord& run) {
  return {run.error, run.motion_error, run.contact ? std::optional(run.contact->reference_area) : std::nullopt, run.message};
}

void set(results::RunRecord& run, const ComparedRun& compared) {
  run.error = compared.error;
  run.motion_error = compared.motion_error;
  if (compared.reference_area) run.contact->reference_area = *compared.reference_area;
  run.message = compared.message;
}

std::vector<ComparedRun> compare_with_reference(const model::Scene& scene, std::vector<MeasuredRun>& runs,
                                                const SweepOptions& options, Checkpoint& checkpoint) {
  bool previewed = false;
  ReferenceReports reports(checkpoint, scene.name);
  References references(options.agreement, {options.limits.seconds, [&](const std::string& pace) {
                                              if (!std::exchange(previewed, true))
                                                for (const MeasuredRun& measured : runs) checkpoint.note(preview(measured.run));
                                              reports(pace);
                                            }});
  measure_errors(scene, runs, references);
  std::vector<ComparedRun> all;
  for (const MeasuredRun& measured : runs) all.push_back(compared(measured.run));
  return all;
}

/// Runs a group. Each run is a checkpoint, and so are their repetitions together, which must be interleaved. The reference
/// comes last, since it may take longer than all the rest.
Results run_group(const Group& group, const SweepOptions& options, Checkpoint& checkpoint) {
  const model::Scene& scene = group.front().scene;
  std::vector<MeasuredRun> measured;
  std::string ids;
  checkpoint.each(group, [&](const RunSpec& spec) {
    const std::string id = identity(spec, options);
    ids += id;
    measured.push_back(checkpoint.once(fmt::format("{} {}", title(spec), id), [&] {
      checkpoint.show(title(spec));
      MeasuredRun one = measure(spec, options);
      one.run.cell = id;
      return one;
    }));
    checkpoint.advance();
  });
  checkpoint.show("timing " + scene.name);
  auto timed = checkpoint.timed("times " + base::long_hash_text(ids),
                                [&] { return time_all(group, options.repetitions, measured, checkpoint); });
  for (std::size_t k = 0; k < measured.size(); ++k) {
    if (timed[k].times.empty()) continue;
    measured[k].run.times_ms = std::move(timed[k].times);
    measured[k].run.work.push_back({"timed_steps", "accepted steps of a repetition that was timed", timed[k].steps});
  }
  if (options.reference) {
    const auto all = checkpoint.once("errors", [&] { return compare_with_reference(scene, measured, options, checkpoint); });
    for (std::size_t k = 0; k < measured.size(); ++k) set(measured[k].run, all[k]);
    checkpoint.advance();
  }
  Results group_results;
  for (MeasuredRun& one : measured) group_results.runs.push_back(std::move(one.run));
  return group_results;
}

/// A job for each group; neither may be gone before the jobs are done.
std::vector<Job> sweep_jobs(const std::vector<Group>& groups, const SweepOptions& options) {
  if (options.frames_every) require_trajectories(groups, options);
  const auto parts_of = [&](const Group& group) {
    return static_cast<int>(group.size()) * (1 + options.repetitions) + (options.reference ? 1 : 0);
  };
  std::vector<Job> jobs;
  for (const Group& group : groups)
    jobs.push_back({fmt::format("group {}", jobs.size()), parts_of(group),
                    [&](Checkpoint& checkpoint) { return run_group(group, options, checkpoint); }});
  return jobs;
}

}  // namespace

std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options) {
  std::vector<results::RunRecord> all = record_in_file(options, identity(groups, options), sweep_jobs(groups, options)).runs;
  if (options.frames_every) results::write_xdmf(options.out, all);
  return all;
}

std::string compute_shard(const std::vector<Group>& groups, const SweepOptions& options) {
  return compute_shard(options, identity(groups, options), sweep_jobs(groups, options));
}

std::filesystem::path default_out(const std::string& job) {
  const std::filesystem::path folder = std::filesystem::path("results") / "runs";
  base::create_folder(folder, "; choose a file by --out");
  return folder / fmt::format("{:%Y-%m-%dT%H-%M-%SZ}-{}-{}.h5", fmt::gmtime(std::time(nullptr)), job, getpid());
}

}  // namespace drape::bench
