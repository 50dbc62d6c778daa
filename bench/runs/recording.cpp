#include "bench/runs/recording.hpp"

#include <fmt/format.h>

#include "reference/sundials/sundials_build.hpp"

namespace drape::bench {

void record_in_file(const SweepOptions& options, const std::string& sweep, const std::vector<Job>& jobs) {
  results::Provenance facts = results::provenance(options.command_line, sweep);
  facts.push_back(
      {"sundials_build", reference::sundials_build(), "how the SUNDIALS that was loaded is compiled, and what is ours"});
  results::Journal journal(options.out, facts, options.start);
  results::RunFile file(options.out, facts, options.start);
  if (!file.finished()) {
    if (file.begun() || !journal.empty()) file.note_resumption();
    int parts = 0;
    for (const Job& job : jobs) parts += job.parts;
    Checkpoint checkpoint(journal, parts);
    try {
      for (std::size_t k = 0; k < jobs.size(); ++k) {
        checkpoint.begin(fmt::format("job {}", k));
        jobs[k].record(file, checkpoint);
      }
    } catch (Interrupted& interrupted) {
      if (file.begun() || !journal.empty()) interrupted.out = options.out;  // else there is nothing to continue
      throw;
    }
    file.finish();
  }
  journal.clear();
}

}  // namespace drape::bench
