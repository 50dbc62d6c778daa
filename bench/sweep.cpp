#include "bench/sweep.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "bench/progress.hpp"
#include "bench/timing.hpp"
#include "model/scene_file.hpp"
#include "reference/cache.hpp"
#include "results/run_file.hpp"

namespace drape::bench {
namespace {

/// The reference at several times up to the end: its uncertainty at a single time may be small by chance.
class References {
 public:
  reference::Reference operator()(const model::Scene& scene) {
    constexpr int outputs = 10;
    std::vector<double> times;
    for (int k = 1; k <= outputs; ++k) times.push_back(scene.end * k / outputs);
    const reference::CvodeOptions options{.size = model::size(scene)};
    const auto key = reference::cache_key(model::to_toml(scene), 0, times, options);
    return reference::cached(cache_, key, [&] {
      const model::Cloth cloth = model::compile(scene);
      return reference::reference(cloth.ode, cloth.start, 0, times, options);
    });
  }

  /// Says what went wrong with the cache.
  ~References() {
    for (const std::string& message : cache_.messages()) fmt::print(stderr, "note: {}\n", message);
  }

 private:
  reference::Cache cache_;
};

results::ErrorRecord distance(const results::RunRecord& run, const reference::Reference& reference, double size) {
  const solver::Vectors& x = reference.trajectory.states.back().x;
  return {.rms = reference::rms_distance(run.final_state.x, x) / size,
          .maximum = (run.final_state.x - x).rowwise().norm().maxCoeff() / size,
          .reference = reference.name,
          .reference_tolerance = reference.tolerance,
          .reference_error = *std::ranges::max_element(reference.error) / size};
}

std::string title(const Cell& cell) {
  return fmt::format("{} {} h = {} {}", cell.scene.name, cell.method_name(), cell.step, cell.overrides);
}

/// Errors of the runs of a group that reached their end; all its cells have the same scene.
void measure_errors(const Group& group, std::vector<results::RunRecord>& runs, References& references) {
  const model::Scene& scene = group.front().scene;
  try {
    const reference::Reference reference = references(scene);
    for (results::RunRecord& run : runs)
      if (run.outcome == to_string(solver::Outcome::success)) run.error = distance(run, reference, model::size(scene));
  } catch (const reference::ReferenceError& error) {
    for (results::RunRecord& run : runs)
      run.message += fmt::format("{}no reference: {}", run.message.empty() ? "" : "; ", error.what());
  }
}

}  // namespace

std::vector<results::RunRecord> sweep(const std::vector<Group>& groups, const SweepOptions& options) {
  results::RunFile file(options.out, results::provenance(options.command_line));
  References references;
  int total = 0;
  for (const Group& group : groups)
    total += static_cast<int>(group.size()) * (1 + options.repetitions) + (options.reference ? 1 : 0);
  Progress progress(total);

  std::vector<results::RunRecord> all;
  for (const Group& group : groups) {
    std::vector<results::RunRecord> runs;
    for (const Cell& cell : group) {
      progress.show(title(cell));
      runs.push_back(record(cell));
      progress.advance();
    }
    if (options.reference) {
      progress.show("reference of " + group.front().scene.name);
      measure_errors(group, runs, references);
      progress.advance();
    }
    progress.show("timing " + group.front().scene.name);
    const auto times = time_group(group, options.repetitions, [&] { progress.advance(); });
    for (std::size_t k = 0; k < runs.size(); ++k) {
      runs[k].times_ms = times[k];
      file.add(runs[k]);
      all.push_back(std::move(runs[k]));
    }
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
