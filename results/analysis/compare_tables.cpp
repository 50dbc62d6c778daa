#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "results/analysis/findings.hpp"

namespace drape::results {
namespace {

/// What is known of a column by its name and unit.
enum class Kind { key, verdict, ignored, work, error, order, other };

bool one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

bool timed(const Column& column) {
  return one_of(column.unit, {"ms", "ns", "s/s", "GB/s", "MB"}) || one_of(column.name, {"wall", "exponent", "repetitions"});
}

Kind kind_of(const Column& column) {
  if (one_of(column.name, {"verdict", "outcome"})) return Kind::verdict;
  if (one_of(column.name, {"spread", "remark", "detail"})) return Kind::ignored;  // text made of numbers
  if (column.unit.empty()) return Kind::key;
  if (timed(column) || one_of(column.name, {"residual", "uncertainty", "order"}))
    return Kind::ignored;  // what a solver left of what it was allowed to leave, and what follows from errors
  if (one_of(column.name, {"updates", "cg_iterations", "steps", "factorisations", "forces", "escalations"})) return Kind::work;
  if (one_of(column.name, {"error", "rms", "maximum", "distance"})) return Kind::error;
  return column.name == "fitted_order" ? Kind::order : Kind::other;
}

bool timed(const Table& table) {
  return std::ranges::any_of(table.columns, [](const Column& column) { return timed(column); });
}

bool counts_work(const Table& table) {
  return std::ranges::any_of(table.columns, [](const Column& column) { return kind_of(column) == Kind::work; });
}

std::string row_name(const Table& table, std::size_t row) {
  std::string name = table.name;
  for (const Column& column : table.columns)
    if (kind_of(column) == Kind::key && !text_in(&column, row).empty()) name += " " + text_in(&column, row);
  return name;
}

bool same_rows(const Table& a, const Table& b) {
  if (rows(a) != rows(b)) return false;
  for (std::size_t row = 0; row < rows(a); ++row)
    if (row_name(a, row) != row_name(b, row)) return false;
  return true;
}

constexpr double round_off = 1e-12;  ///< of numbers in tables

Judgement judge_order(double a, double b) {
  constexpr double steady = 0.05;
  if (std::isnan(a)) return std::isnan(b) ? Judgement::same : Judgement::better;
  return !(b >= a - steady) ? Judgement::regression : b > a + steady ? Judgement::better : Judgement::same;
}

/// A number of which only that is known that it depends on no time: nobody knows which way is better.
Judgement judge_other(double a, double b, double factor) {
  if (std::isnan(a) && std::isnan(b)) return Judgement::same;
  const bool near = a == b || std::abs(b - a) <= (factor - 1) * std::max(std::abs(a), std::abs(b)) + round_off;
  return near ? Judgement::same : Judgement::regression;
}

Judgement judge_verdict(const std::string& a, const std::string& b) {
  const auto bad = [](const std::string& verdict) { return verdict.starts_with("NOT") || verdict.starts_with("no "); };
  return a == b ? Judgement::same : bad(a) && !bad(b) ? Judgement::better : Judgement::regression;
}

struct Judge {
  const CompareOptions& options;
  Findings &accuracy, &work;

  /// `noise`: of errors in this row.
  void cell(const std::string& name, const Column& column, const Column& other, std::size_t row, double noise) const {
    const double a = number_in(&column, row), b = number_in(&other, row);
    switch (kind_of(column)) {
      case Kind::key:
      case Kind::ignored: return;
      case Kind::verdict:
        return note(accuracy, judge_verdict(text_in(&column, row), text_in(&other, row)), name, column, text_in(&column, row),
                    text_in(&other, row), 0);
      case Kind::work:
        return note(work,
                    a == b || (std::isnan(a) && std::isnan(b)) ? Judgement::same
                    : a > b                                    ? Judgement::better
                                                               : Judgement::regression,
                    name, column, shown(a), shown(b), std::log((b + 0.5) / (a + 0.5)));
      case Kind::error:
        return note(accuracy, judge_error(a, b, options.error_factor, noise + round_off), name, column, shown(a), shown(b),
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

double uncertainty(const Table& table, std::size_t row) {
  const double value = number_in(find_column(table, "uncertainty"), row);
  return std::isnan(value) ? 0 : value;
}

void compare_rows(const Table& a, const Table& b, const Judge& judge) {
  for (std::size_t row = 0; row < rows(a); ++row) {
    const std::string name = row_name(a, row);
    if (name.find(" time") != std::string::npos) continue;  // its number is a time, whatever its column's unit says
    ++judge.accuracy.cells;
    judge.work.cells += counts_work(a);
    const double noise = uncertainty(a, row) + uncertainty(b, row);
    for (const Column& column : a.columns)
      if (const Column* other = find_column(b, column.name)) judge.cell(name, column, *other, row, noise);
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
