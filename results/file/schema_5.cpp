#include "results/file/schema_5.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drape::results {
namespace {

const std::vector<std::string> endings{"accurate", "stable but wrong", "stable, error unknown",
                                       "unstable", "not converged",    "not finished"};
const std::vector<std::string> predictions{"stable", "unstable", "loop too slow"};

/// The parts that there are columns for.
void draw_known(Table& table, const std::vector<Binding>& parts) {
  for (const auto& [part, name] : parts)
    if (Column* column = find_column(table, name)) column->part = part;
}

void find_outcomes(Table& table) {
  const auto is_ending = [](const Datum& cell) {
    const auto* text = std::get_if<std::string>(&cell);
    return text != nullptr && std::ranges::find(endings, *text) != endings.end();
  };
  for (Column& column : table.columns) {
    if (column.role != Role::verdict || column.cells.empty()) continue;
    if (column.name == "outcome") column.role = Role::outcome;
    if (!std::ranges::all_of(column.cells, is_ending)) continue;
    column.role = Role::outcome;
    column.classes = endings;
  }
}

/// Who made a trial was known by codes.
void add_sides(Table& trials) {
  Column side{"side", "", "", "", Role::note, {}, {}}, solvers = side, kind = side;
  solvers.name = "solvers", kind.name = "kind";
  side.part = Part::side, solvers.part = kind.part = Part::curve;
  for (std::size_t row = 0; row < rows(trials); ++row) {
    const std::string code = text_in(find_column(trials, "code"), row);
    const bool ours = code == "drape" || code == "explicit" || code == "thesis";
    side.cells.emplace_back(ours ? "ours" : "SUNDIALS");
    solvers.cells.emplace_back(text_in(find_column(trials, "method"), row).empty() ? "" : "automatic");
    kind.cells.emplace_back(code == "drape" ? "" : code);
  }
  trials.columns.push_back(std::move(side));
  trials.columns.push_back(std::move(solvers));
  trials.columns.push_back(std::move(kind));
}

/// Columns over time were called <method>_<quantity>.
void find_groups(Table& table) {
  for (Column& column : table.columns)
    for (const std::string_view end : {"_updates", "_CG", "_contacts"})
      if (column.name.ends_with(end)) {
        column.group = column.name.substr(0, column.name.size() - end.size());
        column.part = Part::y;
      }
}

void find_parts(Table& table) {
  switch (table.figure) {
    case Figure::none:
    case Figure::map:
    case Figure::curves: return;  // versions before 6 had neither
    case Figure::convergence:
      return draw_known(table, {{Part::figure, "scene"},
                                {Part::figure, "experiment"},
                                {Part::curve, "method"},
                                {Part::curve, "form"},
                                {Part::x, "step"},
                                {Part::x, "n"},
                                {Part::y, "error"},
                                {Part::y, "rms"},
                                {Part::detail, "order"}});
    case Figure::work_precision:
      add_sides(table);
      return draw_known(table, {{Part::x, "error"},
                                {Part::y, "time"},
                                {Part::lower, "lower"},
                                {Part::upper, "upper"},
                                {Part::detail, "family"},
                                {Part::detail, "control"},
                                {Part::detail, "value"},
                                {Part::detail, "steps"},
                                {Part::detail, "forces"},
                                {Part::detail, "factorisations"},
                                {Part::caption, "build"}});
    case Figure::stability:
      if (Column* predicted = find_column(table, "predicted")) predicted->classes = predictions;
      return draw_known(table, {{Part::figure, "n"},
                                {Part::figure, "step"},
                                {Part::curve, "method"},
                                {Part::x, "to_damping"},
                                {Part::y, "nu"},
                                {Part::colour, "verdict"},
                                {Part::outline, "predicted"},
                                {Part::detail, "error"},
                                {Part::detail, "uncertainty"},
                                {Part::detail, "reason"}});
    case Figure::over_time: find_groups(table); return draw_known(table, {{Part::x, "t"}});
  }
}

}  // namespace

void complete(Table& table) {
  find_outcomes(table);
  find_parts(table);
  table.for_file = std::ranges::all_of(table.columns, [](const Column& column) { return column.title.empty(); });
  table.timed_rows = table.figure == Figure::work_precision || table.name == "score-trials";
}

}  // namespace drape::results
