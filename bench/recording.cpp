#include "bench/recording.hpp"

namespace drape::bench {

void record_in_file(const SweepOptions& options, const std::string& sweep, int parts, const Work& work) {
  const results::Provenance facts = results::provenance(options.command_line, sweep);
  results::Journal journal(options.out, facts, options.start);
  results::RunFile file(options.out, facts, options.start);
  if (!file.finished()) {
    if (file.begun() || !journal.empty()) file.note_resumption();
    Units units(journal, parts);
    try {
      work(file, units);
    } catch (Interrupted& interrupted) {
      if (file.begun() || !journal.empty()) interrupted.out = options.out;  // else there is nothing to continue
      throw;
    }
    file.finish();
  }
  journal.clear();
}

}  // namespace drape::bench
