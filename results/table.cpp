#include "results/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "results/screen.hpp"
#include "solver/base/printable.hpp"
#include "solver/outcome.hpp"

namespace drape::results {
namespace {

/// In the order of Role.
constexpr std::array<std::string_view, 10> role_names{"key",     "quantity", "error",   "uncertainty", "order",
                                                      "counter", "time",     "outcome", "verdict",     "note"};

/// In the order of Part.
constexpr std::array<std::string_view, 12> part_names{"none",  "figure", "curve",  "side",    "x",      "y",
                                                      "lower", "upper",  "colour", "outline", "detail", "caption"};

/// In the order of Figure.
constexpr std::array<std::string_view, 7> figure_names{"none",      "convergence", "work-precision", "stability",
                                                       "over time", "map",         "curves"};

template <class Value>
std::optional<Value> named(const auto& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Value>(found - names.begin());
}

/// Calls the function for the alternative that a cell holds.
template <class... Functions>
struct Overload : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overload(Functions...) -> Overload<Functions...>;

nlohmann::ordered_json to_value(const Datum& cell) {
  return std::visit(Overload{[](std::monostate) { return nlohmann::ordered_json(); },
                             [](const Verdict& verdict) { return nlohmann::ordered_json(to_string(verdict)); },
                             [](const auto& value) { return nlohmann::ordered_json(value); }},
                    cell);
}

nlohmann::ordered_json to_value(const Table& table) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t row = 0; row < rows(table); ++row) {
    auto object = nlohmann::ordered_json::object();
    for (const Column& column : table.columns) object[column.name] = to_value(column.cells[row]);
    list.push_back(std::move(object));
  }
  return list;
}

std::string dump(const nlohmann::ordered_json& value) {
  return base::printable_lines(value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

/// A text or number of CSV. Programs that calculate would take some texts for formulas, unless an apostrophe is before them.
std::string csv_cell(const Datum& cell) {
  std::string text = to_text(cell, "{}");
  if (std::holds_alternative<double>(cell) || std::holds_alternative<std::int64_t>(cell)) return text;
  if (text.find_first_of("=+-@") == 0) text.insert(0, 1, '\'');
  text = base::printable(text);
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

}  // namespace

std::string_view to_string(Role role) { return role_names[static_cast<std::size_t>(role)]; }

std::optional<Role> role_named(std::string_view name) { return named<Role>(role_names, name); }

std::string_view to_string(Part part) { return part_names[static_cast<std::size_t>(part)]; }

std::optional<Part> part_named(std::string_view name) { return named<Part>(part_names, name); }

std::string_view to_string(Figure figure) { return figure_names[static_cast<std::size_t>(figure)]; }

std::optional<Figure> figure_named(std::string_view name) { return named<Figure>(figure_names, name); }

void draw(Table& table, Figure figure, const std::vector<Binding>& parts) {
  table.figure = figure;
  for (const auto& [part, name] : parts) {
    Column* column = find_column(table, name);
    if (column == nullptr) throw std::invalid_argument(fmt::format("{} has no column {}", table.name, name));
    column->part = part;
  }
}

std::size_t rows(const Table& table) { return table.columns.empty() ? 0 : table.columns.front().cells.size(); }

Column* find_column(Table& table, std::string_view name) {
  const auto found = std::ranges::find(table.columns, name, &Column::name);
  return found == table.columns.end() ? nullptr : &*found;
}

const Column* find_column(const Table& table, std::string_view name) {
  const auto found = std::ranges::find(table.columns, name, &Column::name);
  return found == table.columns.end() ? nullptr : &*found;
}

const Column* find_column(const Table& table, Role role) {
  const auto found = std::ranges::find(table.columns, role, &Column::role);
  return found == table.columns.end() ? nullptr : &*found;
}

bool is_good(const Column& outcomes, std::string_view text) {
  return text == (outcomes.classes.empty() ? to_string(solver::Outcome::success) : outcomes.classes.front());
}

std::string text_in(const Column* column, std::size_t row) {
  if (column == nullptr) return "";
  const Datum& cell = column->cells[row];
  if (const auto* verdict = std::get_if<Verdict>(&cell)) return to_string(*verdict);
  const auto* text = std::get_if<std::string>(&cell);
  return text == nullptr ? "" : *text;
}

Verdict verdict_of(const Datum& cell) {
  if (const auto* verdict = std::get_if<Verdict>(&cell)) return *verdict;
  const auto* text = std::get_if<std::string>(&cell);
  return {Standing::open, text == nullptr ? "" : *text};
}

Standing standing(const Datum& cell) { return verdict_of(cell).standing; }

double number_in(const Column* column, std::size_t row) {
  if (column == nullptr) return std::numeric_limits<double>::quiet_NaN();
  if (const auto* count = std::get_if<std::int64_t>(&column->cells[row])) return static_cast<double>(*count);
  const auto* number = std::get_if<double>(&column->cells[row]);
  return number == nullptr ? std::numeric_limits<double>::quiet_NaN() : *number;
}

std::string to_text(const Datum& cell, std::string_view number) {
  return std::visit(Overload{[](std::monostate) { return std::string(); }, [](const std::string& text) { return text; },
                             [&](double value) { return fmt::format(fmt::runtime(number), value); },
                             [](std::int64_t value) { return std::to_string(value); },
                             [](const Verdict& verdict) { return to_string(verdict); }},
                    cell);
}

std::string to_csv(const Table& table) {
  std::vector<std::string> lines(1 + rows(table));
  std::string_view separator;
  for (const Column& column : table.columns) {
    lines[0] += fmt::format("{}{}", separator, csv_cell(column.name));
    for (std::size_t row = 0; row < column.cells.size(); ++row)
      lines[row + 1] += fmt::format("{}{}", separator, csv_cell(column.cells[row]));
    separator = ",";
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::string to_json(const Table& table) { return dump(to_value(table)); }

std::string to_json(std::span<const Table> tables) {
  auto object = nlohmann::ordered_json::object();
  for (const Table& table : tables) object[table.name] = to_value(table);
  return dump(object);
}

}  // namespace drape::results
