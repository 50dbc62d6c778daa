#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "results/analysis/findings.hpp"
#include "results/verdict.hpp"

namespace drape::results {
namespace {

/// A column of the table a and the one of that name in b. Files of before schema 5 do not say what their columns are: what only
/// one of them takes for a key, a time or a note is left out.
struct Matched {
  const Column *a, *b;
  Role role;
};

Role shared_role(Role a, Role b) {
  const auto either = [&](Role role) { return a == role || b == role; };
  if (a == b) return a;
  return either(Role::key) || either(Role::time) || either(Role::note) ? Role::note : b;
}

std::vector<Matched> matched(const Table& a, const Table& b) {
  std::vector<Matched> columns;
  for (const Column& column : a.columns)
    if (const Column* other = find_column(b, column.name))
      columns.push_back({&column, other, shared_role(column.role, other->role)});
  return columns;
}

bool has(const std::vector<Matched>& columns, Role role) {
  return std::ranges::find(columns, role, &Matched::role) != columns.end();
}

std::string key(const Column& column, std::size_t row) {
  const double number = number_in(&column, row);
  return std::isnan(number) ? text_in(&column, row) : fmt::format("{:.6g}", number);
}

std::string row_name(const std::string& table, const std::vector<Matched>& columns, const Column* Matched::*side,
                     std::size_t row) {
  std::string name = table;
  for (const Matched& column : columns)
    if (const std::string text = column.role == Role::key ? key(*(column.*side), row) : ""; !text.empty())
      name.append(" ").append(text);
  return name;
}

bool same_rows(const Table& a, const Table& b, const std::vector<Matched>& columns) {
  if (rows(a) != rows(b)) return false;
  for (std::size_t row = 0; row < rows(a); ++row)
    if (row_name(a.name, columns, &Matched::a, row) != row_name(b.name, columns, &Matched::b, row)) return false;
  return true;
}

constexpr double round_off = 1e-12;  ///< of numbers in tables

Judgement judge_order(double a, double b) {
  constexpr double steady = 0.05;
  if (std::isnan(a)) return std::isnan(b) ? Judgement::same : Judgement::better;
  return !(b >= a - steady) ? Judgement::regression : b > a + steady ? Judgement::better : Judgement::same;
}

/// The same program counts the same; any more is a regression.
Judgement judge_counter(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return Judgement::same;
  return a > b ? Judgement::better : Judgement::regression;
}

/// A number of which nobody knows which way is better.
Judgement judge_quantity(double a, double b, double factor) {
  if (std::isnan(a) && std::isnan(b)) return Judgement::same;
  const bool near = a == b || std::abs(b - a) <= (factor - 1) * std::max(std::abs(a), std::abs(b)) + round_off;
  return near ? Judgement::same : Judgement::regression;
}

Judgement judge_verdict(const std::string& a, const std::string& b) {
  return a == b ? Judgement::same : standing(b) < standing(a) ? Judgement::better : Judgement::regression;
}

struct Judge {
  const CompareOptions& options;
  Findings &accuracy, &work;

  /// `noise`: of errors in this row.
  void cell(const std::string& name, const Matched& column, std::size_t row, double noise) const {
    const double a = number_in(column.a, row), b = number_in(column.b, row);
    const auto numbers = [&](Findings& findings, Judgement judgement, double change) {
      note(findings, judgement, name, *column.a, shown(a), shown(b), change);
    };
    switch (column.role) {
      case Role::key:
      case Role::uncertainty:
      case Role::time:
      case Role::note: return;
      case Role::verdict: {
        const std::string before = text_in(column.a, row), after = text_in(column.b, row);
        return note(accuracy, judge_verdict(before, after), name, *column.a, before, after, 0);
      }
      case Role::counter: return numbers(work, judge_counter(a, b), std::log((b + 0.5) / (a + 0.5)));
      case Role::error: return numbers(accuracy, judge_error(a, b, options.error_factor, noise + round_off), std::log(b / a));
      case Role::order: return numbers(accuracy, judge_order(a, b), a - b);
      case Role::quantity: return numbers(accuracy, judge_quantity(a, b, options.error_factor), 0);
    }
  }

  static void note(Findings& findings, Judgement judgement, const std::string& name, const Column& column, const std::string& a,
                   const std::string& b, double change) {
    if (judgement != Judgement::same)
      findings.add({name, column.name, a, b, std::isnan(change) ? INFINITY : change, judgement});
  }
};

double uncertainty(const Table& table, std::size_t row) {
  const double value = number_in(find_column(table, Role::uncertainty), row);
  return std::isnan(value) ? 0 : value;
}

void compare_rows(const Table& a, const Table& b, const std::vector<Matched>& columns, const Judge& judge) {
  for (std::size_t row = 0; row < rows(a); ++row) {
    ++judge.accuracy.cells;
    judge.work.cells += has(columns, Role::counter);
    const double noise = uncertainty(a, row) + uncertainty(b, row);
    for (const Matched& column : columns) judge.cell(row_name(a.name, columns, &Matched::a, row), column, row, noise);
  }
}

}  // namespace

void compare_tables(const std::vector<Table>& a, const std::vector<Table>& b, const CompareOptions& options, Findings& accuracy,
                    Findings& work) {
  for (const Table& table : a) {
    const auto other = std::ranges::find(b, table.name, &Table::name);
    if (other == b.end()) {
      accuracy.add({table.name, "table", fmt::format("{} rows", rows(table)), "no such table", 0, Judgement::not_comparable});
      continue;
    }
    const std::vector<Matched> columns = matched(table, *other);
    if (same_rows(table, *other, columns))
      compare_rows(table, *other, columns, {options, accuracy, work});
    else if (!has(columns, Role::time))  // rows of a search for the quickest depend on times
      accuracy.add({table.name, "table", fmt::format("{} rows", rows(table)),
                    fmt::format("{} rows, not the same", rows(*other)), 0, Judgement::not_comparable});
  }
}

}  // namespace drape::results
