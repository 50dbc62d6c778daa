#include "bench/sweep.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "bench/contact_record.hpp"
#include "bench/errors.hpp"
#include "bench/progress.hpp"
#include "bench/timing.hpp"
#include "bench/trajectory_record.hpp"
#include "results/run_file.hpp"
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
  }
  return truth;
}

void compare(results::RunRecord& run, const reference::Reference& reference, const model::Scene& scene,
             const model::Cloth& cloth) {
  run.error = distance(run, reference, scene, cloth);
  const reference::Trajectory& truth = reference.trajectory;
  if (run.contact) run.contact->reference_area = contact_area(scene, cloth, truth.times.back(), truth.states.back().x);
}

void measure_error(const Cell& cell, results::RunRecord& run, const Truth& truth) {
  if (!truth.reference)
    run.message += (run.message.empty() ? "" : "; ") + truth.remark;
  else if (run.outcome == to_string(solver::Outcome::success))
    compare(run, *truth.reference, cell.scene, truth.cloth);
}

/// Before anything is computed.
void require_trajectories(const std::vector<Group>& groups, const SweepOptions& options) {
  for (const Group& group : groups) check_frames(*options.frames_every, group.front().scene.end);
  results::require_creatable(results::xdmf_path(options.out));
}

}  // namespace

std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options) {
  results::RunFile file(options.out, results::provenance(options.command_line));
  if (options.frames_every) require_trajectories(groups, options);
  References references(options.agreement);
  int total = 0;
  for (const Group& group : groups)
    total += static_cast<int>(group.size()) * (1 + options.repetitions) + (options.reference ? 1 : 0);
  Progress progress(total);

  std::vector<results::RunRecord> all;
  for (const Group& group : groups) {
    Truth truth;
    if (options.reference) {
      progress.show("reference of " + group.front().scene.name);
      truth = find_reference(group.front().scene, references);
      progress.advance();
    }
    std::vector<results::RunRecord> runs;
    for (const Cell& cell : group) {
      progress.show(title(cell));
      runs.push_back(record(cell, options.look ? options.look(cell) : solver::Observer(), options.frames_every));
      if (options.reference) measure_error(cell, runs.back(), truth);
      progress.advance();
    }
    progress.show("timing " + group.front().scene.name);
    const auto times = time_group(group, options.repetitions, [&] { progress.advance(); });
    for (std::size_t k = 0; k < runs.size(); ++k) {
      runs[k].times_ms = times[k];
      file.add(runs[k]);
      all.push_back(std::move(runs[k]));
    }
    if (options.frames_every) results::write_xdmf(options.out, all);
  }
  return all;
}

std::filesystem::path default_out(const std::string& job) {
  const std::filesystem::path folder = std::filesystem::path("results") / "runs";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw results::FileError(
        fmt::format("{}: cannot be created ({}); choose a file by --out", folder.string(), error.message()));
  return folder / fmt::format("{:%Y-%m-%dT%H-%M-%SZ}-{}-{}.h5", fmt::gmtime(std::time(nullptr)), job, getpid());
}

}  // namespace drape::bench
