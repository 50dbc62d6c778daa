#include "bench/runs/recording.hpp"

#include <algorithm>
#include <iterator>

#include "reference/sundials/sundials_build.hpp"
#include "results/file/run_file.hpp"

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

Results record_jobs(results::RunFile& file, Checkpoint& checkpoint, const std::vector<Job>& jobs) {
  Results all;
  for (const Job& job : jobs) {
    checkpoint.begin(job.name);
    Results some = job.compute(checkpoint);
    add_missing(file, all.runs.size(), some);
    append(all, std::move(some));
  }
  return all;
}

}  // namespace

Results record_in_file(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs) {
  results::Provenance facts = results::provenance(options.command_line, sweep);
  facts.push_back(
      {"sundials_build", reference::sundials_build(), "how the SUNDIALS that was loaded is compiled, and what is ours"});
  results::Journal journal(options.out, facts, options.start);
  results::RunFile file(options.out, facts, options.start);
  if (file.finished()) {
    journal.clear();
    return {results::read_runs(options.out), results::read_tables(options.out), {}};
  }
  if (file.begun() || !journal.empty()) file.note_resumption();
  int parts = 0;
  for (const Job& job : jobs) parts += job.parts;
  Checkpoint checkpoint(journal, parts);
  try {
    Results all = record_jobs(file, checkpoint, jobs);
    file.finish();
    journal.clear();
    return all;
  } catch (Interrupted& interrupted) {
    if (file.begun() || !journal.empty()) interrupted.out = options.out;  // else there is nothing to continue
    throw;
  }
}

}  // namespace drape::bench
