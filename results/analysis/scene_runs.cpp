#include "results/analysis/scene_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace drape::results {

RunsOfScene by_scene(std::span<const Recording> recordings) {
  RunsOfScene scenes;
  for (const Recording& recording : recordings)
    for (const RunRecord& run : recording.runs)
      scenes[run.overrides.empty() ? run.scene : fmt::format("{} {}", run.scene, run.overrides)].push_back(&run);
  return scenes;
}

Measured measured(const RunRecord& run) {
  if (!run.succeeded() || !run.error || !comparable(*run.error) || run.times_ms.empty()) return {NAN, {}};
  return {std::max(run.error->rms, resolution * run.error->reference_error), run.times_ms};
}

std::string row_title(const Table& table, std::size_t row, bool of_curve) {
  std::string title;
  for (const Column& column : table.columns) {
    if (column.role != Role::key || column.title.empty()) continue;
    const double number = number_in(&column, row);
    const std::string text = std::isnan(number) ? text_in(&column, row)
                             : of_curve         ? ""
                                                : fmt::format("{} {:g}", column.title, number);
    if (!text.empty()) title.append(title.empty() ? "" : " ").append(text);
  }
  return title;
}

OrderCount count_orders(const Table& table) {
  const Column *verdicts = find_column(table, Role::verdict), *fitted = find_column(table, Role::order);
  OrderCount count;
  std::vector<std::string> open;
  for (std::size_t row = 0; row < rows(table); ++row) {
    const std::string verdict = text_in(verdicts, row);
    if (verdict.empty()) continue;
    ++count.curves;
    if (standing(verdicts->cells[row]) == Standing::met) {
      ++count.as_declared;
      continue;
    }
    const std::string order = std::isfinite(number_in(fitted, row)) ? fmt::format(" but {:.2f}", number_in(fitted, row)) : "";
    (standing(verdicts->cells[row]) == Standing::missed ? count.others : open)
        .push_back(fmt::format("{}: {}{}", row_title(table, row, true), verdict, order));
  }
  std::ranges::move(open, std::back_inserter(count.others));
  return count;
}

}  // namespace drape::results
