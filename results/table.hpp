#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "results/verdict.hpp"

namespace drape::results {

/// A value in a table; monostate if there is none.
using Datum = std::variant<std::monostate, std::string, double, std::int64_t, Verdict>;

/// What a column says: compare, the overview and the report go by this, never by names.
enum class Role {
  key,          ///< a row is known by its keys
  quantity,     ///< a number that depends on no time; any change counts
  error,        ///< a number that had better be small
  uncertainty,  ///< of the errors in the row
  order,        ///< a fitted order of convergence
  counter,      ///< work, the same on every machine
  time,         ///< what depends on the machine and the hour
  outcome,      ///< how a run ended, or what became of it: see is_good()
  verdict,      ///< what the row comes to: a Verdict, or a text that classifies, such as "converges"
  note,         ///< for users only
};

/// The role as files name it, for example "key".
std::string_view to_string(Role role);

/// Nothing if no role has this name.
std::optional<Role> role_named(std::string_view name);

/// What the figure of a table takes a column for.
enum class Part {
  none,
  figure,   ///< there is a figure for each of its values
  curve,    ///< in the figure there is a curve, or a map, for each of its values
  side,     ///< there is also a curve of the best for each of its values
  x,        ///< the horizontal axis
  y,        ///< the vertical axis; of several in a group each has an axis of its own
  lower,    ///< end of the bars of y
  upper,    ///< end of the bars of y
  colour,   ///< its classes are the colours of a map
  outline,  ///< lines go round where it is not the first of its classes
  detail,   ///< users see it where they point
  caption,  ///< its first value is said below the figure; of a headline table each is a sentence of the conclusion
};

/// The part as files name it, for example "curve".
std::string_view to_string(Part part);

/// Nothing if no part has this name.
std::optional<Part> part_named(std::string_view name);

/// A column of a table.
struct Column {
  std::string name;         ///< in files, CSV and JSON
  std::string title;        ///< for users; empty if not shown to them
  std::string unit;         ///< "1" for numbers without dimension, empty for text
  std::string description;  ///< what the numbers are
  Role role;
  std::vector<Datum> cells;
  std::vector<std::string> shown;         ///< what users see in place of the cells; empty: the cells, numbers with four digits
  std::vector<std::string> classes = {};  ///< the texts that classify, the best first; empty: any text
  std::string group = {};                 ///< which of several groups of like columns it is in, for example a method
  Part part = Part::none;                 ///< of the figure of its table
};

/// What the report draws of a table besides the table itself.
enum class Figure { none, convergence, work_precision, stability, over_time, map, curves };

/// The figure as files name it, for example "work-precision".
std::string_view to_string(Figure figure);

/// Nothing if no figure has this name.
std::optional<Figure> figure_named(std::string_view name);

/// A result that is not a single run: rows of equally long columns. Plain data.
struct Table {
  std::string name;         ///< unique in a file
  std::string description;  ///< one sentence
  std::vector<Column> columns;
  bool headline = false;  ///< whether the overview shows it whole
  Figure figure = Figure::none;
  bool timed_rows = false;  ///< whether it depends on times which rows there are, as in a search for the quickest
  bool for_file = false;    ///< whether users see it only where they ask for it, then with all columns
};

/// A part of a figure and the column that is taken for it.
struct Binding {
  Part part;
  std::string_view column;
};

/// Has the report draw a figure of the table. Throws std::invalid_argument if there is no such column.
void draw(Table& table, Figure figure, const std::vector<Binding>& parts);

/// The number of rows.
std::size_t rows(const Table& table);

/// The column with this name, null if there is none.
const Column* find_column(const Table& table, std::string_view name);
Column* find_column(Table& table, std::string_view name);

/// The first column with this role, null if there is none.
const Column* find_column(const Table& table, Role role);

/// Whether a text in a column of outcomes is the best one: the first of its classes; if it has none, success.
bool is_good(const Column& outcomes, std::string_view text);

/// A cell's text, that of its verdict included, empty if it has none; its number, NaN if it has none. Without a column there is
/// none.
std::string text_in(const Column* column, std::size_t row);
double number_in(const Column* column, std::size_t row);

/// The verdict in a cell. A text that classifies is open, and so is a cell without any.
Verdict verdict_of(const Datum& cell);
Standing standing(const Datum& cell);

/// One line per row, aligned for users; "no rows" without any. Columns without any value are left out, and those without a
/// title unless the table is for the file.
std::string to_text(const Table& table);

/// All columns with a header (RFC 4180, but lines end with a line feed). Numbers read back as the same numbers; a cell is
/// empty where there is no value.
std::string to_csv(const Table& table);

/// A list of objects with the columns' names as keys; null where there is no value or no finite one.
std::string to_json(const Table& table);

/// An object with the tables' names as keys and their lists as values.
std::string to_json(std::span<const Table> tables);

}  // namespace drape::results
