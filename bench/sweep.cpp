#include "bench/sweep.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "bench/contact_record.hpp"
#include "bench/errors.hpp"
#include "bench/identity.hpp"
#include "bench/recording.hpp"
#include "bench/timing.hpp"
#include "bench/trajectory_record.hpp"
#include "results/xdmf.hpp"

namespace drape::bench {
namespace {

std::string title(const Cell& cell) {
  return fmt::format("{} {} h = {} {}", cell.scene.name, cell.method_name(), cell.step, cell.overrides);
}

void compare(results::RunRecord& run, const reference::Reference& reference, const model::Scene& scene,
             const model::Cloth& cloth) {
  run.error = distance(run, reference, scene, cloth);
  const reference::Trajectory& truth = reference.trajectory;
  if (run.contact) run.contact->reference_area = contact_area(scene, cloth, truth.times.back(), truth.states.back().x);
}

/// Compares all runs that succeeded; returns the smallest of their errors, over the size.
double compare_all(std::vector<results::RunRecord>& runs, const reference::Reference& reference, const model::Scene& scene,
                   const model::Cloth& cloth) {
  double smallest = std::numeric_limits<double>::infinity();
  for (results::RunRecord& run : runs) {
    if (run.outcome != to_string(solver::Outcome::success)) continue;
    compare(run, reference, scene, cloth);
    smallest = std::min(smallest, run.error->rms);
  }
  return smallest;
}

/// Measures the runs of a group by the reference of their common scene, which is as tight as the smallest error needs, or says
/// with each why there is none.
void measure_errors(const model::Scene& scene, std::vector<results::RunRecord>& runs, References& references) {
  const model::Cloth cloth = model::compile(scene);
  try {
    const reference::Reference first = references(scene, cloth);
    const double smallest = compare_all(runs, first, scene, cloth);
    if (cloth.ode.contacts || 10 * std::ranges::max(first.error) <= smallest * model::size(scene)) return;
    compare_all(runs, references.resolving(scene, cloth, smallest), scene, cloth);
  } catch (const reference::ReferenceError& error) {
    for (results::RunRecord& run : runs)
      run.message += fmt::format("{}no reference: {}", run.message.empty() ? "" : "; ", error.what());
  }
}

/// Before anything is computed.
void require_trajectories(const std::vector<Group>& groups, const SweepOptions& options) {
  for (const Group& group : groups) check_frames("--trajectory", *options.frames_every, group.front().scene.end);
  if (options.start == results::Start::fresh) results::require_creatable(results::xdmf_path(options.out));
}

/// Times those runs of a group that have kept their limits; the others have no times.
std::vector<std::vector<double>> time_all(const Group& group, int repetitions, const std::vector<results::RunRecord>& runs,
                                          Units& units) {
  Group timed;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < group.size(); ++k) {
    if (runs[k].outcome == out_of_time || runs[k].outcome == out_of_memory) continue;
    timed.push_back(group[k]);
    places.push_back(k);
  }
  const auto times = time_group(timed, repetitions, [&] { units.advance(); });
  std::vector<std::vector<double>> all(group.size());
  for (std::size_t k = 0; k < timed.size(); ++k) all[places[k]] = times[k];
  return all;
}

/// What is known of a run before its error is.
std::string preview(const results::RunRecord& run) {
  std::string line = fmt::format("{} {} h = {}: {}", run.scene, run.method, run.step, run.outcome);
  if (!run.times_ms.empty()) line += fmt::format(", {:.4g} ms", std::ranges::min(run.times_ms));
  return line + "; its error follows";
}

/// Runs a group and records it as a whole: each cell is a unit of work, and so are their repetitions together, which must be
/// interleaved. The reference comes last, since it may take longer than all the rest.
void run_group(const Group& group, const SweepOptions& options, results::RunFile& file, Units& units) {
  const model::Scene& scene = group.front().scene;
  std::vector<results::RunRecord> runs;
  std::string ids;
  for (const Cell& cell : group) {
    const std::string id = identity(cell, options);
    ids += id;
    runs.push_back(units(id, [&] {
      units.show(title(cell));
      results::RunRecord run =
          record(cell, options.look ? options.look(cell) : solver::Observer(), options.frames_every, options.limits);
      run.cell = id;
      return run;
    }));
    units.advance();
  }
  units.show("timing " + scene.name);
  const auto times = units("times " + hash_of(ids), [&] { return time_all(group, options.repetitions, runs, units); });
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].times_ms = times[k];
  if (options.reference) {
    units.show("reference of " + scene.name);
    bool previewed = false;
    References references(options.agreement, {options.limits.seconds, [&](const std::string& pace) {
                                                if (!std::exchange(previewed, true))
                                                  for (const results::RunRecord& run : runs) units.note(preview(run));
                                                units.report("reference of " + scene.name + ": " + pace);
                                              }});
    measure_errors(scene, runs, references);
    check_interruption();
    units.advance();
  }
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
    const std::size_t recorded = file.run_count();
    std::size_t before = 0;  // runs of the groups before this one
    for (const Group& group : groups) {
      if (before >= recorded)
        run_group(group, options, file, units);
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
