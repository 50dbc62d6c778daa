#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "results/findings.hpp"

namespace drape::results {
namespace {

/// What is known of a column by its name and unit.
enum class Kind { key, verdict, time, work, error, order, other };

bool one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

Kind kind_of(const Column& column) {
  if (one_of(column.name, {"verdict", "outcome"})) return Kind::verdict;
  if (one_of(column.name, {"spread", "remark", "detail"})) return Kind::time;  // text made of numbers
  if (column.unit.empty()) return Kind::key;
  if (one_of(column.unit, {"ms", "ns", "s/s", "GB/s", "MB"}) || one_of(column.name, {"wall", "exponent", "repetitions"}))
    return Kind::time;
  if (one_of(column.name, {"updates", "cg_iterations", "steps", "factorisations", "forces", "escalations"})) return Kind::work;
  if (one_of(column.name, {"error", "rms", "maximum", "distance", "residual"})) return Kind::error;
  return column.name == "fitted_order" ? Kind::order : Kind::other;
}

bool timed(const Table& table) {
  return std::ranges::any_of(table.columns, [](const Column& c) { return !c.unit.empty() && kind_of(c) == Kind::time; });
}

std::string text_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return "";
}

double number_of(const Cell& cell) {
  if (const auto* value = std::get_if<double>(&cell)) return *value;
  if (const auto* count = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*count);
  return NAN;
}

std::size_t rows(const Table& table) { return table.columns.empty() ? 0 : table.columns.front().cells.size(); }

std::string row_name(const Table& table, std::size_t row) {
  std::string name = table.name;
  for (const Column& column : table.columns)
    if (kind_of(column) == Kind::key && !text_of(column.cells[row]).empty()) name += " " + text_of(column.cells[row]);
  return name;
}

bool same_rows(const Table& a, const Table& b) {
  if (rows(a) != rows(b)) return false;
  for (std::size_t row = 0; row < rows(a); ++row)
    if (row_name(a, row) != row_name(b, row)) return false;
  return true;
}

constexpr double round_off = 1e-12;  ///< of errors in tables

Judgement judge_order(double a, double b) {
  constexpr double steady = 0.05;
  if (std::isnan(a)) return std::isnan(b) ? Judgement::same : Judgement::better;
  return !(b >= a - steady) ? Judgement::regression : b > a + steady ? Judgement::better : Judgement::same;
}

/// A number of which only that is known that it depends on no time: nobody knows which way is better.
Judgement judge_other(double a, double b, double factor) {
  if (std::isnan(a) && std::isnan(b)) return Judgement::same;
  const bool near = a == b || std::abs(b - a) <= (factor - 1) * std::max(std::abs(a), std::abs(b));
  return near ? Judgement::same : Judgement::regression;
}

Judgement judge_verdict(const std::string& a, const std::string& b) {
  const auto bad = [](const std::string& verdict) { return verdict.starts_with("NOT") || verdict.starts_with("no "); };
  return a == b ? Judgement::same : bad(a) && !bad(b) ? Judgement::better : Judgement::regression;
}

struct Judge {
  const CompareOptions& options;
  Findings &accuracy, &work;

  void cell(const std::string& name, const Column& column, const Cell& in_a, const Cell& in_b) const {
    const double a = number_of(in_a), b = number_of(in_b);
    switch (kind_of(column)) {
      case Kind::key:
      case Kind::time: return;
      case Kind::verdict:
        return note(accuracy, judge_verdict(text_of(in_a), text_of(in_b)), name, column, text_of(in_a), text_of(in_b), 0);
      case Kind::work:
        return note(work,
                    a == b || (std::isnan(a) && std::isnan(b)) ? Judgement::same
                    : a > b                                    ? Judgement::better
                                                               : Judgement::regression,
                    name, column, shown(a), shown(b), std::log((b + 0.5) / (a + 0.5)));
      case Kind::error:
        return note(accuracy, judge_error(a, b, options.error_factor, round_off), name, column, shown(a), shown(b),
                    std::log(b / a));
      case Kind::order: return note(accuracy, judge_order(a, b), name, column, shown(a), shown(b), a - b);
      case Kind::other: return note(accuracy, judge_other(a, b, options.error_factor), name, column, shown(a), shown(b), 0);
    }
  }

  static void note(Findings& findings, Judgement judgement, const std::string& name, const Column& column, const std::string& a,
                   const std::string& b, double change) {
    if (judgement != Judgement::same)
      findings.add({name, column.name, a, b, std::isnan(change) ? INFINITY : change, judgement});
  }
};

void compare_rows(const Table& a, const Table& b, const Judge& judge) {
  for (std::size_t row = 0; row < rows(a); ++row) {
    const std::string name = row_name(a, row);
    if (name.find(" time") != std::string::npos) continue;  // its number is a time, whatever its column's unit says
    ++judge.accuracy.cells;
    for (const Column& column : a.columns)
      if (const auto other = std::ranges::find(b.columns, column.name, &Column::name); other != b.columns.end())
        judge.cell(name, column, column.cells[row], other->cells[row]);
  }
}

}  // namespace

void compare_tables(const std::vector<Table>& a, const std::vector<Table>& b, const CompareOptions& options, Findings& accuracy,
                    Findings& work) {
  for (const Table& table : a) {
    const auto other = std::ranges::find(b, table.name, &Table::name);
    if (other != b.end() && same_rows(table, *other)) {
      compare_rows(table, *other, {options, accuracy, work});
    } else if (other == b.end() || !timed(table)) {  // rows of a search for the quickest depend on times
      accuracy.add({table.name, "table", fmt::format("{} rows", rows(table)),
                    other == b.end() ? "no such table" : fmt::format("{} rows, not the same", rows(*other)), 0,
                    Judgement::not_comparable});
    }
  }
}

}  // namespace drape::results
