#include "bench/runs/recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "reference/sundials/sundials_build.hpp"
#include "results/file/run_file.hpp"
#include "solver/base/atomic_file.hpp"

namespace drape::bench {
namespace {

/// Adds what a process before this one has not. Runs are known by their number, tables by their name.
void add_missing(results::RunFile& file, std::size_t runs_before, const Results& some) {
  if (!some.runs.empty() && runs_before >= file.run_count()) file.add(some.runs);
  for (const results::Table& table : some.tables)
    if (!file.has_table(table.name)) file.add(table);
}

void append(Results& all, Results&& some) {
  std::ranges::move(some.runs, std::back_inserter(all.runs));
  std::ranges::move(some.tables, std::back_inserter(all.tables));
  all.summary += some.summary;
}

/// `record` is given the results of each job, and the number of runs before it.
Results do_jobs(Checkpoint& checkpoint, const std::vector<Job>& jobs,
                const std::function<void(std::size_t runs_before, const Results& some)>& record) {
  Results all;
  checkpoint.each(jobs, [&](const Job& job) {
    checkpoint.begin(job.name);
    Results some = job.compute(checkpoint);
    record(all.runs.size(), some);
    append(all, std::move(some));
  });
  return all;
}

results::Provenance facts_of(const SweepOptions& options, const std::string& sweep) {
  results::Provenance facts = results::provenance(options.command_line, sweep);
  facts.push_back(
      {"sundials_build", reference::sundials_build(), "how the SUNDIALS that was loaded is compiled, and what is ours"});
  return facts;
}

int count_parts(const std::vector<Job>& jobs) {
  int parts = 0;
  for (const Job& job : jobs) parts += job.parts;
  return parts;
}

// --- Shards ------------------------------------------------------------------------------------------------------------------

/// The numbers of shards that have yet to compute something: "1, 3".
std::string numbers_of(const Shards& shards) {
  std::set<int> numbers;
  for (const auto& [id, number] : shards.missing()) numbers.insert(number);
  return fmt::format("{}", fmt::join(numbers, ", "));
}

std::string missing_text(const Shards& shards, const SweepOptions& options, int count) {
  std::vector<std::string> missing;
  for (const auto& [id, number] : shards.missing()) missing.push_back(fmt::format("'{}' of shard {}", id, number));
  return fmt::format(
      "{}: not yet recorded: shards {} of {} lack {} checkpoints: {}; compute them by the same command with --shard i/{}",
      options.out.string(), numbers_of(shards), count, missing.size(), first_of(missing), count);
}

bool has_times(const Results& all) {
  const auto is_time = [](const results::Column& column) { return column.role == results::Role::time; };
  return std::ranges::any_of(all.runs, [](const results::RunRecord& run) { return !run.times_ms.empty(); }) ||
         std::ranges::any_of(all.tables,
                             [&](const results::Table& table) { return std::ranges::any_of(table.columns, is_time); });
}

/// Throws MissingCheckpoints unless shards have all that the jobs need, and FileError if times of several machines are among
/// it.
void require_mergeable(const ShardJournals& read, Shards& shards, results::Journal& journal, const SweepOptions& options,
                       const std::vector<Job>& jobs) {
  Checkpoint checkpoint(journal, count_parts(jobs), &shards);
  try {
    const Results all = do_jobs(checkpoint, jobs, [](std::size_t, const Results&) {});
    if (read.processors.size() > 1 && has_times(all))
      throw base::FileError(
          fmt::format("{}: cannot be recorded: shards have times of different machines: {}; expected one kind of processor",
                      options.out.string(), fmt::join(read.processors, ", ")));
  } catch (const ComputedElsewhere&) {
    throw MissingCheckpoints(missing_text(shards, options, read.share.count));
  }
}

}  // namespace

Results record_in_file(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs) {
  results::Provenance facts = facts_of(options, sweep);
  std::optional<Shards> shards;
  std::optional<ShardJournals> read;
  if (!options.merged.empty()) {
    read = read_shards(options.merged, facts);
    shards.emplace(read->share, std::move(read->checkpoints));
    facts = read->facts;
  }
  results::Journal journal(options.out, facts, options.start);
  results::RunFile file(options.out, facts, options.start);
  if (file.finished()) {
    if (shards) throw base::FileError(fmt::format("{}: is recorded already; choose another file", options.out.string()));
    journal.clear();
    return {results::read_runs(options.out), results::read_tables(options.out), {}};
  }
  if (file.begun() || !journal.empty()) file.note_resumption();
  if (shards) require_mergeable(*read, *shards, journal, options, jobs);
  Checkpoint checkpoint(journal, count_parts(jobs), shards ? &*shards : nullptr);
  try {
    Results all =
        do_jobs(checkpoint, jobs, [&](std::size_t runs_before, const Results& some) { add_missing(file, runs_before, some); });
    file.finish();
    journal.clear();
    return all;
  } catch (Interrupted& interrupted) {
    if (file.begun() || !journal.empty()) interrupted.out = options.out;  // else there is nothing to continue
    throw;
  }
}

std::string compute_shard(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs) {
  const Share share = options.shard.value();
  const std::filesystem::path file = shard_file(options.out, share);
  base::require_creatable(options.out);  // else it is recorded already
  const results::Provenance facts = facts_of(options, sweep);
  results::Journal journal(file, facts, results::Start::resumed);
  if (journal.find(origin_id) == nullptr) journal.add(origin_id, origin(facts, share));
  MachineLock machine;
  for (;;) {
    Shards shards(share, checkpoints_beside(options.out, share, facts));
    const std::size_t before = journal.size();
    try {
      Checkpoint checkpoint(journal, count_parts(jobs), &shards, &machine);
      do_jobs(checkpoint, jobs, [](std::size_t, const Results&) {});
      return fmt::format("shard {}: all shards are complete, this one in {}.journal", to_string(share), file.string());
    } catch (const ComputedElsewhere&) {  // what others have computed meanwhile may let this one go on
      if (journal.size() > before) continue;
      return fmt::format("shard {}: {} checkpoints in {}.journal; {} of shards {} are not there yet", to_string(share),
                         journal.size() - 1, file.string(), shards.missing().size(), numbers_of(shards));
    } catch (Interrupted& interrupted) {
      interrupted.out = options.out;
      throw;
    }
  }
}

}  // namespace drape::bench
