#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/runs/checkpoint.hpp"
#include "bench/runs/sweep_options.hpp"
#include "results/run_record.hpp"
#include "results/table.hpp"

namespace drape::bench {

/// What is recorded of a job.
struct Results {
  std::vector<results::RunRecord> runs = {};
  std::vector<results::Table> tables = {};
  std::string summary = {};  ///< of the tables, for users; not recorded
};

/// What a sweep records as a whole: a group of runs, or what is made of a list of rows. What takes seconds is a checkpoint,
/// which a process that was killed does not lose.
struct Job {
  std::string name;  ///< unique in a sweep: ids of checkpoints belong to it
  int parts;         ///< how often `compute` advances the checkpoint
  std::function<Results(Checkpoint& checkpoint)> compute;
};

namespace detail {

inline Results to_results(Results all) { return all; }
inline Results to_results(std::vector<results::Table> tables) { return {.tables = std::move(tables)}; }
inline Results to_results(results::Table table) {
  Results all;
  all.tables.push_back(std::move(table));
  return all;
}

}  // namespace detail

/// Computing apart from presenting: `compute(checkpoint)` gives rows, and `present(rows)` the table, tables or Results that are
/// made of them. What the rows point into must stay where it is when they are moved.
template <class Compute, class Present>
Job job(std::string name, int parts, Compute compute, Present present) {
  return {std::move(name), parts, [=](Checkpoint& checkpoint) { return detail::to_results(present(compute(checkpoint))); }};
}

/// Begins or continues the file that the options name, does the jobs one after the other, and marks the file as finished. After
/// each job its results are in the file. A process before this one leaves checkpoints, so that all jobs are done again from
/// these at little cost, and nothing is recorded twice. If the file is finished already, nothing is done but to read it.
/// `sweep`: identity of the jobs. Returns all results. Throws base::FileError, and Interrupted, naming the file.
///
/// If the options name journals of shards, all is taken from these, as if this process had computed it. Throws
/// MissingCheckpoints, and what read_shards() throws, before there is a file.
Results record_in_file(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs);

/// Shards lack results; the message names them and the numbers of the shards.
struct MissingCheckpoints : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Computes the shard of the jobs that the options name, as far as that is possible without what others have yet to compute,
/// and keeps it in its journal. A process before this one, and those that run beside it, have left theirs. Returns what there
/// is to say about it. Throws like record_in_file().
std::string compute_shard(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs);

}  // namespace drape::bench
