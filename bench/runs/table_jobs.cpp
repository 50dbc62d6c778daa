#include "bench/runs/table_jobs.hpp"

#include "bench/runs/recording.hpp"

namespace drape::bench {

std::vector<results::Table> compute(const std::vector<TableJob>& jobs, const std::string& identity,
                                    const SweepOptions& options) {
  std::vector<results::Table> tables;
  std::vector<Job> all;
  for (const TableJob& job : jobs)
    all.push_back({job.parts, [&](results::RunFile& file, Checkpoint& checkpoint) {
                     tables.push_back(job.compute(checkpoint));  // also if the file has it: later tables may be made from it
                     if (!file.has_table(tables.back().name)) file.add(tables.back());
                   }});
  record_in_file(options, identity, all);
  return tables.empty() ? results::read_tables(options.out) : tables;
}

}  // namespace drape::bench
