#include "bench/runs/recording.hpp"

#include "reference/sundials/sundials_build.hpp"

namespace drape::bench {

void record_in_file(const SweepOptions& options, const std::string& sweep, int parts, const Work& work) {
  results::Provenance facts = results::provenance(options.command_line, sweep);
  facts.push_back(
      {"sundials_build", reference::sundials_build(), "how the SUNDIALS that was loaded is compiled, and what is ours"});
  results::Journal journal(options.out, facts, options.start);
  results::RunFile file(options.out, facts, options.start);
  if (!file.finished()) {
    if (file.begun() || !journal.empty()) file.note_resumption();
    Checkpoint checkpoint(journal, parts);
    try {
      work(file, checkpoint);
    } catch (Interrupted& interrupted) {
      if (file.begun() || !journal.empty()) interrupted.out = options.out;  // else there is nothing to continue
      throw;
    }
    file.finish();
  }
  journal.clear();
}

}  // namespace drape::bench
