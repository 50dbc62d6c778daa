#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "results/analysis/differences.hpp"
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

/// Rows of both tables with the same keys; those that only one of them has.
struct MatchedRows {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::size_t> only_a, only_b;
};

MatchedRows matched_rows(const Table& a, const Table& b, const std::vector<Matched>& columns) {
  std::multimap<std::string, std::size_t> rows_of_b;
  for (std::size_t row = 0; row < rows(b); ++row) rows_of_b.emplace(row_name(b.name, columns, &Matched::b, row), row);
  MatchedRows matched;
  for (std::size_t row = 0; row < rows(a); ++row) {
    const auto found = rows_of_b.find(row_name(a.name, columns, &Matched::a, row));  // the first of equal ones
    if (found == rows_of_b.end()) {
      matched.only_a.push_back(row);
    } else {
      matched.pairs.emplace_back(row, found->second);
      rows_of_b.erase(found);
    }
  }
  for (const auto& [name, row] : rows_of_b) matched.only_b.push_back(row);
  return matched;
}

constexpr double round_off = 1e-12;  ///< of numbers in tables

Change judge_order(double a, double b) {
  constexpr double steady = 0.05;
  if (std::isnan(a)) return std::isnan(b) ? Change::same : Change::better;
  return !(b >= a - steady) ? Change::regression : b > a + steady ? Change::better : Change::same;
}

/// The same program counts the same; any more is a regression.
Change judge_counter(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return Change::same;
  return a > b ? Change::better : Change::regression;
}

/// A number whose better direction is unknown.
Change judge_quantity(double a, double b, double factor) {
  if (std::isnan(a) && std::isnan(b)) return Change::same;
  const bool near = a == b || std::abs(b - a) <= (factor - 1) * std::max(std::abs(a), std::abs(b)) + round_off;
  return near ? Change::same : Change::regression;
}

Change judge_verdict(const Verdict& a, const Verdict& b) {
  return a == b ? Change::same : b.standing < a.standing ? Change::better : Change::regression;
}

/// How a run failed may differ.
Change judge_outcome(const Column& a, const std::string& before, const Column& b, const std::string& after) {
  if (before == after) return Change::same;
  const bool was_good = is_good(a, before), good = is_good(b, after);
  return was_good == good ? Change::changed : good ? Change::better : Change::regression;
}

struct Judge {
  const CompareOptions& options;
  Differences &accuracy, &work;

  /// `row` of a and `other` of b; `noise`: of errors in them.
  void cell(const std::string& name, const Matched& column, std::size_t row, std::size_t other, double noise) const {
    const double a = number_in(column.a, row), b = number_in(column.b, other);
    const auto numbers = [&](Differences& differences, Change change, double severity) {
      note(differences, change, name, *column.a, shown(a), shown(b), severity);
    };
    switch (column.role) {
      case Role::key:
      case Role::uncertainty:
      case Role::time:
      case Role::note: return;
      case Role::outcome: {
        const std::string before = text_in(column.a, row), after = text_in(column.b, other);
        return note(accuracy, judge_outcome(*column.a, before, *column.b, after), name, *column.a, before, after, 0);
      }
      case Role::verdict: {
        const Change change = judge_verdict(verdict_of(column.a->cells[row]), verdict_of(column.b->cells[other]));
        return note(accuracy, change, name, *column.a, text_in(column.a, row), text_in(column.b, other), 0);
      }
      case Role::counter: return numbers(work, judge_counter(a, b), std::log((b + 0.5) / (a + 0.5)));
      case Role::error: return numbers(accuracy, judge_error(a, b, options.error_factor, noise + round_off), std::log(b / a));
      case Role::order: return numbers(accuracy, judge_order(a, b), a - b);
      case Role::quantity: return numbers(accuracy, judge_quantity(a, b, options.error_factor), 0);
    }
  }

  static void note(Differences& differences, Change change, const std::string& name, const Column& column, const std::string& a,
                   const std::string& b, double severity) {
    if (change != Change::same) differences.add({name, column.name, a, b, std::isnan(severity) ? INFINITY : severity, change});
  }
};

double uncertainty(const Table& table, std::size_t row) {
  const double value = number_in(find_column(table, Role::uncertainty), row);
  return std::isnan(value) ? 0 : value;
}

double largest_uncertainty(const Table& table) {
  double largest = 0;
  for (std::size_t row = 0; row < rows(table); ++row) largest = std::max(largest, uncertainty(table, row));
  return largest;
}

/// Rows whose error a reference that is this uncertain resolves. Where a curve ends depends on its reference's round-off.
std::size_t resolved_rows(const Table& table, const std::vector<std::size_t>& some, double uncertainty) {
  const Column* errors = find_column(table, Role::error);
  return static_cast<std::size_t>(
      std::ranges::count_if(some, [&](std::size_t row) { return !(number_in(errors, row) < resolution * uncertainty); }));
}

void compare_rows(const Table& a, const Table& b, const MatchedRows& matched, const std::vector<Matched>& columns,
                  const Judge& judge) {
  for (const auto& [row, other] : matched.pairs) {
    ++judge.accuracy.cells;
    judge.work.cells += has(columns, Role::counter);
    const double noise = uncertainty(a, row) + uncertainty(b, other);
    for (const Matched& column : columns) judge.cell(row_name(a.name, columns, &Matched::a, row), column, row, other, noise);
  }
}

}  // namespace

void compare_tables(const std::vector<Table>& a, const std::vector<Table>& b, const CompareOptions& options,
                    Differences& accuracy, Differences& work) {
  const auto not_comparable = [&](const Table& table, const std::string& in_a, const std::string& in_b) {
    accuracy.add({table.name, "table", in_a, in_b, 0, Change::not_comparable});
  };
  for (const Table& table : a) {
    const auto other = std::ranges::find(b, table.name, &Table::name);
    if (other == b.end()) {
      not_comparable(table, fmt::format("{} rows", rows(table)), "no such table");
      continue;
    }
    const std::vector<Matched> columns = matched(table, *other);
    const MatchedRows found = matched_rows(table, *other, columns);
    compare_rows(table, *other, found, columns, {options, accuracy, work});
    if (table.timed_rows || other->timed_rows) continue;
    const double noise = std::max(largest_uncertainty(table), largest_uncertainty(*other));
    const std::size_t lost = resolved_rows(table, found.only_a, noise), gained = resolved_rows(*other, found.only_b, noise);
    if (lost + gained > 0)
      not_comparable(table, fmt::format("{} rows that b has not", lost), fmt::format("{} rows that a has not", gained));
  }
}

}  // namespace drape::results
