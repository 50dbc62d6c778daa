#include "results/analysis/overview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "results/analysis/conclusion.hpp"
#include "results/analysis/scene_runs.hpp"
#include "results/table_builder.hpp"

namespace drape::results {
namespace {

/// The texts that people see in a row, but for its verdict and how it varies.
std::string row_title(const Table& table, std::size_t row) {
  std::string title;
  for (const Column& column : table.columns) {
    const bool told = column.name == "verdict" || column.name == "spread";
    if (const std::string text = text_in(&column, row); !told && !column.title.empty() && !text.empty())
      title += (title.empty() ? "" : " ") + text;
  }
  return title;
}

bool has_orders(const Table& table) { return find_column(table, "fitted_order") != nullptr; }

// --- Orders --------------------------------------------------------------------------------------------------------------

void add_orders(const Table& table, TableBuilder& overview) {
  const Column *verdicts = find_column(table, "verdict"), *fitted = find_column(table, "fitted_order");
  const OrderCount count = count_orders(table);
  if (count.curves == 0) return;
  std::string others;
  for (std::size_t row = 0; row < rows(table); ++row) {
    const std::string verdict = text_in(verdicts, row);
    if (verdict.empty() || is_as_declared(verdict)) continue;
    others += fmt::format("{}{}: {}{}", others.empty() ? "" : "; ", row_title(table, row), verdict,
                          std::isfinite(number_in(fitted, row)) ? fmt::format(" but {:.2f}", number_in(fitted, row)) : "");
  }
  overview.row();
  overview.text("table", "table", "its name", table.name);
  overview.text("good", "as declared", "curves whose order is as declared, of all",
                fmt::format("{} of {}", count.as_declared, count.curves));
  overview.text("others", "the others", "their verdicts", others);
}

// --- Runs ----------------------------------------------------------------------------------------------------------------

void add_quickest(const std::string& scene, const std::vector<const RunRecord*>& runs, TableBuilder& overview) {
  std::vector<Measured> candidates;
  for (const RunRecord* run : runs) candidates.push_back(measured(*run));
  if (std::ranges::all_of(candidates, [](const Measured& one) { return std::isnan(one.error); })) return;
  overview.row();
  overview.text("scene", "scene", "its name, and what is set in it", scene);
  for (int digits = 1; digits <= 7; ++digits) {
    const auto best = quickest(candidates, std::pow(10, -digits));
    const std::string name = fmt::format("1e-{}", digits);
    overview.text(name.c_str(), name.c_str(), "method and step of the quickest run with that error",
                  best ? fmt::format("{} {:g}", runs[*best]->method, runs[*best]->step) : "");
  }
}

void add_failures(const std::string& scene, const std::vector<const RunRecord*>& runs, TableBuilder& overview) {
  for (const RunRecord* run : runs) {
    if (ended_well(*run)) continue;
    overview.row();
    overview.text("scene", "scene", "its name, and what is set in it", scene);
    overview.text("method", "method", "time integrator", run->method);
    overview.number("step", "step", "s", "time step h", run->step);
    overview.text("outcome", "outcome", "how it failed", std::string(to_string(run->outcome)));
    overview.number("reached", "reached", "s", "last good time", run->last_good_time);
    overview.text("message", "why", "what the program says", run->message);
  }
}

// --- Other verdicts ------------------------------------------------------------------------------------------------------

void add_not_met(const Table& table, TableBuilder& overview) {
  const Column* verdicts = find_column(table, "verdict");
  for (std::size_t row = 0; verdicts != nullptr && row < rows(table); ++row) {
    const std::string verdict = text_in(verdicts, row);
    if (!verdict.starts_with("NOT")) continue;
    overview.row();
    overview.text("table", "table", "its name", table.name);
    const double error = number_in(find_column(table, "error"), row);
    overview.text("row", "row", "what it is about",
                  row_title(table, row) + (std::isfinite(error) ? fmt::format(" at {:g}", error) : ""));
    overview.text("verdict", "verdict", "what the program says", verdict);
  }
}

/// At most so many rows, and how many more there are.
Table shortened(Table table, std::size_t most) {
  const std::size_t all = rows(table);
  if (all <= most) return table;
  for (Column& column : table.columns) column.cells.resize(most);
  table.description += fmt::format(" ({} more)", all - most);
  return table;
}

}  // namespace

std::vector<Table> overview(std::span<const Recording> recordings) {
  TableBuilder orders("orders", "Orders of convergence"),
      quickest_runs("quickest-runs", "The quickest recorded run at each error: method and step [s]"),
      failures("failures", "Runs that failed"), not_met("not-met", "What is not as it was wanted");
  for (const Recording& recording : recordings)
    for (const Table& table : recording.tables) has_orders(table) ? add_orders(table, orders) : add_not_met(table, not_met);
  for (const auto& [scene, runs] : by_scene(recordings)) {
    add_quickest(scene, runs, quickest_runs);
    add_failures(scene, runs, failures);
  }
  std::vector<Table> tables;
  if (Table words = conclusion(recordings); rows(words) > 0) tables.push_back(std::move(words));
  for (const Recording& recording : recordings)
    std::ranges::copy_if(recording.tables, std::back_inserter(tables),
                         [](const Table& table) { return table.headline && rows(table) > 0; });
  for (TableBuilder* table : {&orders, &quickest_runs, &failures, &not_met})
    if (Table done = shortened(table->finish(), 10); rows(done) > 0) tables.push_back(std::move(done));
  return tables;
}

}  // namespace drape::results
