#include "bench/commands/dry_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <optional>
#include <sstream>
#include <system_error>

#include "bench/runs/certified_reference.hpp"
#include "bench/runs/identity.hpp"
#include "bench/runs/progress.hpp"
#include "bench/runs/run.hpp"
#include "results/file/run_file.hpp"
#include "solver/base/atomic_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double longest_probe = 0.5;     ///< [s] of a run
constexpr double all_probes = 10;         ///< [s] of all runs together
constexpr double longest_reference = 2;   ///< [s]
constexpr std::size_t most_records = 50;  ///< that are read, the newest

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  const long minutes = std::lround(seconds / 60);
  return minutes < 100 ? fmt::format("{} min", minutes) : fmt::format("{:.1f} h", seconds / 3600);
}

std::string counted(int count, const char* what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

// --- Records -----------------------------------------------------------------------------------------------------------------

/// A file in which the same sweep was recorded from its start to its end.
struct Record {
  fs::path file;
  std::string started, cpu;
  double seconds = 0;
};

std::optional<std::time_t> time_of(const std::string& iso) {
  std::tm parts{};
  std::istringstream stream(iso);
  stream >> std::get_time(&parts, "%Y-%m-%dT%H:%M:%SZ");
  return stream.fail() ? std::nullopt : std::optional(timegm(&parts));
}

std::optional<Record> record_of(const fs::path& file, const std::string& sweep) try {
  const results::Provenance facts = results::read_provenance(file);
  const auto begin = time_of(value_of(facts, "started")), end = time_of(value_of(facts, "finished"));
  if (value_of(facts, "sweep") != sweep || !value_of(facts, "resumed").empty() || !begin || !end) return std::nullopt;
  return Record{file, value_of(facts, "started"), value_of(facts, "cpu"), std::difftime(*end, *begin)};
} catch (const base::FileError&) {
  return std::nullopt;  // of another program, or half-written
}

/// The newest in the folders where results are by default.
std::optional<Record> newest_record(const std::string& sweep, const std::string& name) {
  std::vector<fs::path> files;
  for (const char* folder : {"results/baselines", "results/runs"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
      if (entry.path().extension() == ".h5" && entry.path().filename().string().find(name) != std::string::npos)
        files.push_back(entry.path());
  }
  std::ranges::sort(files, std::greater(), &fs::path::filename);
  files.resize(std::min(files.size(), most_records));
  std::optional<Record> newest;
  for (const fs::path& file : files)
    if (const auto record = record_of(file, sweep); record && (!newest || record->started > newest->started)) newest = record;
  return newest;
}

void print_record(const Record& record) {
  fmt::print("time: {}, as {} took, recorded on {} of {}\n", duration(std::max(1.0, record.seconds)),
             base::printable(record.file.string()), record.started.substr(0, 10), base::printable(record.cpu));
}

// --- Probes ------------------------------------------------------------------------------------------------------------------

/// Seconds, as far as they can be told.
struct Estimate {
  double seconds = 0;
  int unknown = 0;  ///< of what is not in it
};

/// `limit` [s] of each probe.
std::string text_of(const Estimate& estimate, const char* kind, double limit) {
  const std::string without =
      estimate.unknown > 0 ? fmt::format("; {} of them ended no step and are not in it", estimate.unknown) : "";
  return fmt::format("{} for the {}, from probes of at most {:.2g} s each{}", duration(estimate.seconds), kind, limit, without);
}

void add(Estimate& sum, double seconds, double most) {
  if (std::isnan(seconds))
    ++sum.unknown;
  else
    sum.seconds += std::min(seconds, most);
}

/// What a run takes, if all of it is as slow as what was done within some seconds; not a number if that was nothing.
double probed(const RunSpec& spec, double most_seconds) {
  std::optional<model::Cloth> cloth;
  const auto begin = Clock::now();
  const RunEnd end = run(spec, cloth, {}, {.seconds = most_seconds, .interruptible_steps = true});
  const double elapsed = seconds_since(begin);
  if (end.result.outcome != solver::Outcome::out_of_time) return elapsed;
  const double reached = end.result.last_good_time;
  return reached > 0 ? elapsed * spec.scene.end / reached : std::nan("");
}

/// [s] of the probe of each of some runs.
double longest_of(int runs) { return std::min(longest_probe, all_probes / runs); }

/// Each run is recorded once and timed some times.
Estimate of_runs(const std::vector<Group>& groups, const SweepOptions& options, int runs, Progress& progress) {
  Estimate sum;
  const double most = std::min(longest_of(runs), options.limits.seconds);
  for (const Group& group : groups)
    for (const RunSpec& spec : group) {
      progress.show(spec.scene.name + " " + spec.method_name());
      add(sum, (1 + options.repetitions) * probed(spec, most), (1 + options.repetitions) * options.limits.seconds);
      progress.advance();
    }
  return sum;
}

/// How far the first of the threads that compute a reference has come.
class ReferenceCourse {
 public:
  void watch(solver::SplitOde& ode) {
    for (auto* part : {&ode.force, &ode.explicit_force})
      *part = [this, force = *part](double t, const solver::Vectors& x, const solver::Vectors& v, solver::Vectors& f) {
        if (t == 0 && t_ > 0) ++ended_;
        t_ = t;
        force(t, x, v, f);
      };
  }

  /// The part of all motions that is done, from 0 to 1.
  double share(double end) const { return (ended_ + t_ / end) / reference::first_motions; }

 private:
  int ended_ = 0;
  double t_ = 0;
};

/// What a reference takes; not a number if that cannot be told. One that is computed within the probe is then known.
double probed_reference(const model::Scene& scene, double agreement) {
  model::Cloth cloth = model::compile(scene);
  ReferenceCourse course;
  course.watch(cloth.ode);
  const auto begin = Clock::now();
  try {
    References(agreement, {.seconds = longest_reference})(scene, cloth);
  } catch (const reference::ReferenceError& error) {
    if (error.flag != "OUT_OF_TIME") return seconds_since(begin);  // there is none
    const double share = course.share(scene.end);
    return share > 0 ? seconds_since(begin) / std::min(share, 1.0) : std::nan("");
  } catch (const reference::NotCertified&) {
  }
  return seconds_since(begin);
}

Estimate of_references(const std::vector<Group>& groups, const SweepOptions& options, Progress& progress) {
  Estimate sum;
  for (const Group& group : groups) {
    const model::Scene& scene = group.front().scene;
    progress.show("reference of " + scene.name);
    add(sum, probed_reference(scene, options.agreement), options.limits.seconds);
    progress.advance();
  }
  return sum;
}

}  // namespace

void print_plan(const std::vector<Group>& groups, const SweepOptions& options, const std::string& name) {
  int runs = 0;
  for (const Group& group : groups) runs += static_cast<int>(group.size());
  const int references = options.reference ? static_cast<int>(groups.size()) : 0;
  fmt::print("{}: {}, each also timed {} times, {}\n", name, counted(runs, "run"), options.repetitions,
             counted(references, "reference"));
  if (const auto record = newest_record(identity(groups, options), name)) return print_record(*record);
  Estimate of_all, of_true;
  {
    Progress progress(runs + references);
    of_all = of_runs(groups, options, runs, progress);
    if (options.reference) of_true = of_references(groups, options, progress);
  }
  fmt::print("time: {}\n", text_of(of_all, "runs", longest_of(runs)));
  if (options.reference)
    fmt::print("      {}; less where they are kept, more where errors are small\n",
               text_of(of_true, "references", longest_reference));
}

void print_plan(const std::vector<Job>& jobs, const std::string& sweep, const std::string& name) {
  int parts = 0;
  for (const Job& job : jobs) parts += job.parts;
  fmt::print("{}: {} of {} together\n", name, counted(static_cast<int>(jobs.size()), "job"), counted(parts, "part"));
  if (const auto record = newest_record(sweep, name)) return print_record(*record);
  fmt::print("time: not known, no finished record of the same is in results/runs or results/baselines\n");
}

}  // namespace drape::bench
