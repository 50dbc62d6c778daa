#include "results/analysis/overview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "results/analysis/conclusion.hpp"
#include "results/analysis/scene_runs.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::results {
namespace {

// --- Orders --------------------------------------------------------------------------------------------------------------

struct OrderRow {
  std::string table, as_declared, others;
};

constexpr ColumnOf<OrderRow> order_columns[] = {
    {"table", "table", "", "its name", Role::key, field<&OrderRow::table>},
    {"good", "as declared", "", "curves whose order is as declared, of all", Role::note, field<&OrderRow::as_declared>},
    {"others", "the others", "", "their verdicts", Role::note, field<&OrderRow::others>},
};

OrderRow order_row(const Table& table, const OrderCount& count) {
  return {table.name, fmt::format("{} of {}", count.as_declared, count.curves),
          fmt::format("{}", fmt::join(count.others, "; "))};
}

// --- Runs ----------------------------------------------------------------------------------------------------------------

constexpr int decades = 7;  ///< of errors, from 1e-1 on

struct QuickestRuns {
  std::string scene;
  std::array<std::string, decades> runs;  ///< at 1e-1, 1e-2, …
};

template <std::size_t digit>
constexpr ColumnOf<QuickestRuns> at_error(const char* name) {
  return {name,       name,
          "",         "method and step of the quickest run with that error",
          Role::note, [](const QuickestRuns& row) -> Datum { return row.runs[digit - 1]; }};
}

constexpr ColumnOf<QuickestRuns> quickest_columns[] = {
    {"scene", "scene", "", "its name, and what is set in it", Role::key, field<&QuickestRuns::scene>},
    at_error<1>("1e-1"),
    at_error<2>("1e-2"),
    at_error<3>("1e-3"),
    at_error<4>("1e-4"),
    at_error<5>("1e-5"),
    at_error<6>("1e-6"),
    at_error<7>("1e-7"),
};

std::optional<QuickestRuns> quickest_runs(const std::string& scene, const std::vector<const RunRecord*>& runs) {
  std::vector<Measured> candidates;
  for (const RunRecord* run : runs) candidates.push_back(measured(*run));
  if (std::ranges::all_of(candidates, [](const Measured& one) { return std::isnan(one.error); })) return std::nullopt;
  QuickestRuns row{scene, {}};
  for (int digit = 1; digit <= decades; ++digit)
    if (const auto best = quickest(candidates, std::pow(10, -digit)))
      row.runs[digit - 1] = fmt::format("{} {:g}", runs[*best]->method, runs[*best]->step);
  return row;
}

struct Failure {
  std::string scene;
  const RunRecord* run;
};

constexpr ColumnOf<Failure> failure_columns[] = {
    {"scene", "scene", "", "its name, and what is set in it", Role::key, field<&Failure::scene>},
    {"method", "method", "", "time integrator", Role::key, [](const Failure& row) -> Datum { return row.run->method; }},
    {"step", "step", "s", "time step h", Role::key, [](const Failure& row) -> Datum { return row.run->step; }},
    {"outcome", "outcome", "", "how it failed", Role::outcome, [](const Failure& row) { return to_datum(row.run->outcome); }},
    {"reached", "reached", "s", "last good time", Role::quantity,
     [](const Failure& row) -> Datum { return row.run->last_good_time; }},
    {"message", "why", "", "what the program says", Role::note, [](const Failure& row) -> Datum { return row.run->message; }},
};

// --- Other verdicts and outcomes ------------------------------------------------------------------------------------------

struct Missed {
  std::string table, row;
  Verdict verdict;
};

constexpr ColumnOf<Missed> missed_columns[] = {
    {"table", "table", "", "its name", Role::key, field<&Missed::table>},
    {"row", "row", "", "what it is about", Role::key, field<&Missed::row>},
    {"verdict", "verdict", "", "what the program says", Role::verdict, field<&Missed::verdict>},
};

/// Whether a cell says that something is not as it was wanted. Classes only say what there is.
bool is_missed(const Column& column, std::size_t row) {
  if (column.role == Role::verdict) return standing(column.cells[row]) == Standing::missed;
  const std::string text = text_in(&column, row);
  return column.role == Role::outcome && column.classes.empty() && !text.empty() && !is_good(column, text);
}

/// Searches, which are for the file, try what may fail.
void add_missed(const Table& table, std::vector<Missed>& missed) {
  for (std::size_t row = 0; !table.for_file && row < rows(table); ++row)
    for (const Column& column : table.columns)
      if (is_missed(column, row)) missed.push_back({table.name, row_title(table, row), verdict_of(column.cells[row])});
}

/// At most `most` rows, and the number of those left out.
Table shortened(Table table, std::size_t most) {
  const std::size_t all = rows(table);
  if (all <= most) return table;
  for (Column& column : table.columns) column.cells.resize(most);
  table.description += fmt::format(" ({} more)", all - most);
  return table;
}

}  // namespace

std::vector<Table> overview(std::span<const Recording> recordings) {
  std::vector<Table> tables{conclusion(recordings)};
  std::vector<OrderRow> orders;
  std::vector<Missed> missed;
  for (const Recording& recording : recordings)
    for (const Table& table : recording.tables) {
      if (table.headline) tables.push_back(table);
      if (find_column(table, Role::order) == nullptr)
        add_missed(table, missed);
      else if (const OrderCount count = count_orders(table); count.curves > 0)
        orders.push_back(order_row(table, count));
    }
  std::vector<QuickestRuns> quickest;
  std::vector<Failure> failures;
  for (const auto& [scene, runs] : by_scene(recordings)) {
    if (auto row = quickest_runs(scene, runs)) quickest.push_back(std::move(*row));
    for (const RunRecord* run : runs)
      if (!run->succeeded()) failures.push_back({scene, run});
  }
  const auto add = [&](Table table) { tables.push_back(shortened(std::move(table), 10)); };
  add(make_table("orders", "Orders of convergence", order_columns, orders));
  add(make_table("quickest-runs", "The quickest recorded run at each error: method and step [s]", quickest_columns, quickest));
  add(make_table("failures", "Runs that failed", failure_columns, failures));
  add(make_table("not-met", "Targets missed", missed_columns, missed));
  std::erase_if(tables, [](const Table& table) { return rows(table) == 0; });
  return tables;
}

}  // namespace drape::results
