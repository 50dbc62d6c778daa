#include "verify/support/all_but_times.hpp"

#include <fmt/format.h>

#include <vector>

#include "results/file/run_file.hpp"
#include "verify/support/record_text.hpp"

namespace drape::verify {

std::string all_but_times(const std::filesystem::path& file) {
  std::string text;
  for (const auto& [name, value, description] : results::read_provenance(file))
    if (name != "started" && name != "command_line" && name != "resumed" && name != "finished")
      text += fmt::format("{} {} {}\n", name, value, description);
  for (results::RunRecord& run : results::read_runs(file)) {
    text += fmt::format("{} times\n", run.times_ms.size());
    run.times_ms.clear();
    text += as_text(run);
  }
  for (results::Table& table : results::read_tables(file)) {
    std::erase_if(table.columns, [](const results::Column& column) { return column.role == results::Role::time; });
    text += fmt::format("{}\n{}\n{}", table.name, table.description, to_csv(table));
  }
  return text;
}

}  // namespace drape::verify
