#include "bench/runs/table_jobs.hpp"

#include <fmt/format.h>

#include "bench/runs/recording.hpp"

namespace drape::bench {

std::vector<results::Table> compute(const std::vector<TableJob>& jobs, const std::string& identity,
                                    const SweepOptions& options) {
  int parts = 0;
  for (const TableJob& job : jobs) parts += job.parts;
  std::vector<results::Table> tables;
  record_in_file(options, identity, parts, [&](results::RunFile& file, Checkpoint& checkpoint) {
    for (std::size_t k = 0; k < jobs.size(); ++k) {
      checkpoint.begin(fmt::format("table {}", k));
      tables.push_back(
          jobs[k].compute(checkpoint));  // also if the file has it: later tables may be made from what this one saw
      if (!file.has_table(tables.back().name)) file.add(tables.back());
    }
  });
  return tables.empty() ? results::read_tables(options.out) : tables;
}

}  // namespace drape::bench
