#include "results/file/table_in_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "results/file/dimensions.hpp"
#include "results/file/schema_4.hpp"
#include "results/file/schema_5.hpp"

namespace drape::results {
namespace {

using hdf5::Handle;

template <class Value>
bool is(const Datum& cell) {
  return std::holds_alternative<Value>(cell);
}

double number(const Datum& cell) {
  if (const auto* value = std::get_if<double>(&cell)) return *value;
  if (const auto* value = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*value);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string standings_of(const std::string& column) { return column + ".standing"; }

/// Beside the details of verdicts stand their standings.
void write_texts(const Handle& group, const Column& column) {
  std::vector<std::string> texts, standings;
  for (const Datum& cell : column.cells) {
    texts.push_back(verdict_of(cell).detail);
    standings.emplace_back(is<Verdict>(cell) ? to_string(standing(cell)) : "");
  }
  hdf5::write_texts(group, column.name, texts, column.description);
  if (std::ranges::any_of(column.cells, is<Verdict>))
    hdf5::write_texts(group, standings_of(column.name), standings, "met, open or missed; empty: the text beside it classifies");
}

bool is_number(const Datum& cell) { return is<double>(cell) || is<std::int64_t>(cell); }
bool is_text(const Datum& cell) { return is<std::string>(cell) || is<Verdict>(cell); }

/// A column has one type in the file: text, whole numbers if all its cells are such, else real numbers, NaN for none. Throws
/// std::logic_error where that would lose a cell.
void write_column(const Handle& group, const Column& column) {
  const auto& [name, title, unit, description, role, cells, shown, classes, in_group, part] = column;
  if (unit.empty() ? std::ranges::any_of(cells, is_number) : std::ranges::any_of(cells, is_text))
    throw std::logic_error(fmt::format("column '{}': numbers need a unit (\"1\" for none), texts have none", name));
  if (unit.empty()) {
    write_texts(group, column);
  } else if (!cells.empty() && std::ranges::all_of(cells, is<std::int64_t>)) {
    std::vector<std::int64_t> counts;
    for (const Datum& cell : cells) counts.push_back(std::get<std::int64_t>(cell));
    hdf5::write_numbers(group, name, counts.data(), {counts.size()}, unit, description);
  } else {
    std::vector<double> numbers;
    std::ranges::transform(cells, std::back_inserter(numbers), number);
    hdf5::write_numbers(group, name, numbers.data(), {numbers.size()}, unit, description);
  }
  hdf5::write_text(group, name + ".title", title);
  hdf5::write_text(group, name + ".role", std::string(to_string(role)));
  hdf5::write_text(group, name + ".group", in_group);
  hdf5::write_text(group, name + ".part", std::string(to_string(part)));
  if (!classes.empty()) hdf5::write_texts(group, name + ".classes", classes, "the texts that classify, the best first");
}

/// `find` gives what has this name.
auto read_named(const std::string& attribute, const std::string& name, const auto& find) {
  const auto found = find(name);
  if (!found) throw hdf5::Error(fmt::format("{} is '{}', which this program does not know", attribute, name));
  return *found;
}

Role read_role(const Handle& group, const std::string& column) {
  return read_named(column + ".role", hdf5::read_text(group, column + ".role"), role_named);
}

/// What a column has from version 6 on.
void read_newer(const Handle& group, Column& column) {
  column.group = hdf5::read_text(group, column.name + ".group");
  column.part = read_named(column.name + ".part", hdf5::read_text(group, column.name + ".part"), part_named);
  if (hdf5::has(group, column.name + ".classes")) column.classes = hdf5::read_texts(group, column.name + ".classes");
}

/// Texts; in a column of verdicts with their standings.
std::vector<Datum> read_texts(const Handle& group, const std::string& name, Role role, int version) {
  const auto texts = hdf5::read_texts(group, name);
  if (role != Role::verdict) return {texts.begin(), texts.end()};
  std::vector<Datum> cells;
  if (!hdf5::has(group, standings_of(name))) {
    for (const std::string& text : texts) cells.push_back(written_verdict(text, version));
    return cells;
  }
  const auto standings = hdf5::read_texts(group, standings_of(name));
  if (standings.size() != texts.size()) throw hdf5::Error(fmt::format("{} must be as long as {}", standings_of(name), name));
  for (std::size_t row = 0; row < texts.size(); ++row)
    cells.push_back(standings[row].empty()
                        ? Datum(texts[row])
                        : Verdict{read_named(standings_of(name), standings[row], standing_named), texts[row]});
  return cells;
}

std::vector<Datum> read_cells(const Handle& group, const std::string& name, const std::string& unit, Role role, int version) {
  if (unit.empty()) return read_texts(group, name, role, version);
  const auto numbers = hdf5::read_numbers<double>(group, name);
  std::vector<Datum> cells;
  for (const double value : numbers) cells.push_back(value == value ? Datum(value) : Datum());
  return cells;
}

}  // namespace

void write_table(const Handle& tables, const Table& table) {
  const Handle group = hdf5::create_group(tables, table.name, table.description);
  std::vector<std::string> names;
  for (const Column& column : table.columns) {
    write_column(group, column);
    names.push_back(column.name);
  }
  hdf5::write_texts(group, "columns", names, "the columns in their order");
  hdf5::write_integer(group, "headline", table.headline ? 1 : 0);
  hdf5::write_integer(group, "timed_rows", table.timed_rows ? 1 : 0);
  hdf5::write_integer(group, "for_file", table.for_file ? 1 : 0);
  hdf5::write_text(group, "figure", std::string(to_string(table.figure)));
  write_row_scale(group, rows(table));
  name_dimensions_of_table(group);
}

std::vector<std::string> column_names(const Handle& group, int version) {
  if (version > 5) return hdf5::read_texts(group, "columns");
  std::istringstream names(hdf5::read_text(group, "columns"));
  return {std::istream_iterator<std::string>(names), {}};
}

Table read_table(const Handle& tables, const std::string& name, int version) {
  const Handle group = hdf5::open_group(tables, name);
  Table table{name, hdf5::read_text(group, "description"), {}};
  const auto infos = hdf5::datasets(group);
  for (const std::string& column : column_names(group, version)) {
    const auto info = std::ranges::find(infos, column, &hdf5::DatasetInfo::name);
    if (info == infos.end()) throw hdf5::Error(fmt::format("the column {} of the table {} is missing", column, name));
    const Role role = version > 4 ? read_role(group, column) : usual_role(column, info->unit);
    table.columns.push_back({column,
                             hdf5::read_text(group, column + ".title"),
                             info->unit,
                             info->description,
                             role,
                             read_cells(group, column, info->unit, role, version),
                             {}});
    if (version > 5) read_newer(group, table.columns.back());
    if (table.columns.back().cells.size() != rows(table))
      throw hdf5::Error(fmt::format("the columns of the table {} are not equally long", name));
  }
  if (version > 4) {
    table.headline = hdf5::read_integer(group, "headline") != 0;
    table.figure = read_named("figure", hdf5::read_text(group, "figure"), figure_named);
  } else {
    table.figure = usual_figure(table);
    if (table.figure == Figure::convergence) move_to_first_rows(table);
  }
  if (version > 5) {
    table.timed_rows = hdf5::read_integer(group, "timed_rows") != 0;
    table.for_file = hdf5::read_integer(group, "for_file") != 0;
  } else {
    complete(table);
  }
  return table;
}

}  // namespace drape::results
