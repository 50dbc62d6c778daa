#include "bench/table_jobs.hpp"

#include "results/run_file.hpp"

namespace drape::bench {

std::vector<results::Table> compute(const std::vector<TableJob>& jobs, const std::filesystem::path& out,
                                    const std::string& command_line) {
  results::RunFile file(out, results::provenance(command_line));
  int parts = 0;
  for (const TableJob& job : jobs) parts += job.parts;
  Progress progress(parts);
  std::vector<results::Table> tables;
  for (const TableJob& job : jobs) file.add(tables.emplace_back(job.compute(progress)));
  return tables;
}

}  // namespace drape::bench
