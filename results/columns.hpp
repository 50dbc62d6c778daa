#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "results/table.hpp"
#include "solver/outcome.hpp"

/// Tables from rows: a study computes rows, plain structs, and a list of columns says what a table shows of them.
namespace drape::results {

inline Datum to_datum(std::string text) { return text; }
inline Datum to_datum(std::string_view text) { return std::string(text); }
inline Datum to_datum(const char* text) { return std::string(text); }
inline Datum to_datum(Verdict verdict) { return verdict; }
inline Datum to_datum(double value) { return value; }
inline Datum to_datum(std::integral auto value) { return static_cast<std::int64_t>(value); }
inline Datum to_datum(solver::Outcome outcome) { return std::string(to_string(outcome)); }
template <class Value>
Datum to_datum(const std::optional<Value>& value) {
  return value ? to_datum(*value) : Datum();
}

/// A member of a row as its cell: field<&Row::step>.
template <auto member>
constexpr auto field = [](const auto& row) -> Datum { return to_datum(row.*member); };

/// A column of a table with rows of this type.
template <class Row>
struct ColumnOf {
  const char* name;         ///< in files, CSV and JSON
  const char* title;        ///< for users; empty if not shown to them
  const char* unit;         ///< "1" for numbers without dimension, empty for text
  const char* description;  ///< what the numbers are
  Role role;
  Datum (*value)(const Row& row);
  std::string (*shown)(const Row& row) = nullptr;  ///< if users see something else
  std::span<const std::string_view> classes = {};  ///< the texts that classify, the best first
};

/// What columns of several groups differ in: it stands for "{}" in their names, titles and descriptions.
struct ColumnGroup {
  std::string_view name = {}, title = {}, description = {};
};

namespace detail {

inline std::string filled(std::string_view text, std::string_view filling) {
  const std::size_t place = text.find("{}");
  std::string result(text);
  return place == std::string_view::npos ? result : result.replace(place, 2, filling);
}

template <class Row>
Column column_of(const ColumnOf<Row>& column, const ColumnGroup& group) {
  return {filled(column.name, group.name),
          filled(column.title, group.title),
          column.unit,
          filled(column.description, group.description),
          column.role,
          {},
          {},
          {column.classes.begin(), column.classes.end()},
          std::string(group.name)};
}

}  // namespace detail

/// Appends columns that show a part of each row: `part(row)` gives a pointer to it or an optional one, and where there is none
/// the cells are empty.
template <class Part, std::size_t count, std::ranges::input_range Rows, class Select>
void add_columns(Table& table, const ColumnOf<Part> (&columns)[count], const Rows& rows, const Select& part,
                 const ColumnGroup& group = {}) {
  for (const ColumnOf<Part>& column : columns) {
    Column filled = detail::column_of(column, group);
    for (const auto& row : rows) {
      const auto& found = part(row);
      filled.cells.push_back(found ? column.value(*found) : Datum());
      if (column.shown) filled.shown.push_back(found ? column.shown(*found) : std::string());
    }
    table.columns.push_back(std::move(filled));
  }
}

/// Appends columns of the rows themselves.
template <class Row, std::size_t count, std::ranges::input_range Rows>
void add_columns(Table& table, const ColumnOf<Row> (&columns)[count], const Rows& rows) {
  add_columns(table, columns, rows, [](const Row& row) { return &row; });
}

/// A table of the rows, a column for each of the list.
template <class Row, std::size_t count, std::ranges::input_range Rows>
Table make_table(std::string name, std::string description, const ColumnOf<Row> (&columns)[count], const Rows& rows) {
  Table table{std::move(name), std::move(description), {}};
  add_columns(table, columns, rows);
  return table;
}

}  // namespace drape::results
