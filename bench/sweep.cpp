#include "bench/sweep.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <new>

#include "bench/contact_record.hpp"
#include "bench/errors.hpp"
#include "bench/identity.hpp"
#include "bench/motion_error.hpp"
#include "bench/recording.hpp"
#include "bench/timing.hpp"
#include "bench/trajectory_record.hpp"
#include "results/xdmf.hpp"

namespace drape::bench {
namespace {

std::string title(const Cell& cell) {
  return fmt::format("{} {} h = {} {}", cell.scene.name, cell.method_name(), cell.step, cell.overrides);
}

/// What the runs of a group are measured by: their common scene, compiled once, and its reference or why there is none.
struct Truth {
  model::Cloth cloth;
  std::optional<reference::Reference> reference;
  std::string remark;
};

Truth find_reference(const model::Scene& scene, References& references) {
  Truth truth{model::compile(scene), std::nullopt, ""};
  try {
    truth.reference = references(scene, truth.cloth);
  } catch (const reference::ReferenceError& error) {
    truth.remark = fmt::format("no reference: {}", error.what());
  } catch (const std::bad_alloc&) {
    truth.remark = "no reference: it needs more memory than the machine has";
  }
  return truth;
}

void compare(results::RunRecord& run, const Samples& samples, const reference::Reference& reference, const model::Scene& scene,
             const model::Cloth& cloth) {
  run.error = distance(run, reference, scene, cloth);
  run.motion_error = motion_error(samples.states(), reference, scene, cloth);
  const reference::Trajectory& truth = reference.trajectory;
  if (run.contact) run.contact->reference_area = contact_area(scene, cloth, truth.times.back(), truth.states.back().x);
}

void measure_error(const Cell& cell, results::RunRecord& run, const Samples& samples, const Truth& truth) {
  if (!truth.reference)
    run.message += (run.message.empty() ? "" : "; ") + truth.remark;
  else if (run.outcome == to_string(solver::Outcome::success))
    compare(run, samples, *truth.reference, cell.scene, truth.cloth);
}

/// Before anything is computed.
void require_trajectories(const std::vector<Group>& groups, const SweepOptions& options) {
  for (const Group& group : groups) check_frames("--trajectory", *options.frames_every, group.front().scene.end);
  if (options.start == results::Start::fresh) results::require_creatable(results::xdmf_path(options.out));
}

/// A run that the energy guard ended went one step further than it has recorded.
std::size_t steps_of(const results::RunRecord& run) {
  return run.steps.size() + (run.outcome == to_string(solver::Outcome::unstable) ? 1 : 0);
}

/// Times those runs of a group that have kept their limits, as far as they went.
void time_all(const Group& group, int repetitions, std::vector<results::RunRecord>& runs, Units& units) {
  Group timed;
  std::vector<results::RunRecord*> places;
  for (std::size_t k = 0; k < group.size(); ++k) {
    if (runs[k].outcome == out_of_time || runs[k].outcome == out_of_memory) continue;
    timed.push_back(group[k]);
    timed.back().most_steps = steps_of(runs[k]);
    places.push_back(&runs[k]);
  }
  std::vector<std::size_t> steps;
  auto times = time_group(
      timed, repetitions, [&] { units.advance(); }, &steps);
  for (std::size_t k = 0; k < timed.size(); ++k) {
    places[k]->times_ms = std::move(times[k]);
    places[k]->work.push_back(
        {"timed_steps", "accepted steps of a repetition that was timed", static_cast<std::int64_t>(steps[k])});
  }
}

/// Runs a group and records it as a whole. Each cell is a unit of work, their repetitions are not: they must be interleaved.
void run_group(const Group& group, const SweepOptions& options, References& references, results::RunFile& file, Units& units) {
  std::optional<Truth> truth;
  const auto measured = [&](const Cell& cell) {
    Samples samples(compared_times(cell.scene));
    const solver::Observer look = options.look ? options.look(cell) : solver::Observer();
    const auto see = [&](const solver::StepReport& step) {
      samples.see(step);
      if (look) look(step);
    };
    results::RunRecord run = record(cell, see, options.frames_every, options.limits);
    if (!options.reference) return run;
    if (!truth) {
      units.show("reference of " + group.front().scene.name);
      truth = find_reference(group.front().scene, references);
    }
    measure_error(cell, run, samples, *truth);
    return run;
  };
  std::vector<results::RunRecord> runs;
  for (const Cell& cell : group) {
    const std::string id = identity(cell, options);
    runs.push_back(units(id, [&] {
      units.show(title(cell));
      results::RunRecord run = measured(cell);
      run.cell = id;
      return run;
    }));
    units.advance();
  }
  if (options.reference) units.advance();
  units.show("timing " + group.front().scene.name);
  time_all(group, options.repetitions, runs, units);
  file.add(runs);
}

}  // namespace

std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options) {
  if (options.frames_every) require_trajectories(groups, options);
  const auto parts_of = [&](const Group& group) {
    return static_cast<int>(group.size()) * (1 + options.repetitions) + (options.reference ? 1 : 0);
  };
  int parts = 0;
  for (const Group& group : groups) parts += parts_of(group);
  record_in_file(options, identity(groups, options), parts, [&](results::RunFile& file, Units& units) {
    References references(options.agreement);
    const std::size_t recorded = file.run_count();
    std::size_t before = 0;  // runs of the groups before this one
    for (const Group& group : groups) {
      if (before >= recorded)
        run_group(group, options, references, file, units);
      else
        for (int k = 0; k < parts_of(group); ++k) units.advance();
      before += group.size();
    }
  });
  std::vector<results::RunRecord> all = results::read_runs(options.out);
  if (options.frames_every) results::write_xdmf(options.out, all);
  return all;
}

std::filesystem::path default_out(const std::string& job) {
  const std::filesystem::path folder = std::filesystem::path("results") / "runs";
  results::create_folder(folder, "; choose a file by --out");
  return folder / fmt::format("{:%Y-%m-%dT%H-%M-%SZ}-{}-{}.h5", fmt::gmtime(std::time(nullptr)), job, getpid());
}

}  // namespace drape::bench
