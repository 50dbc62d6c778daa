#include "results/screen.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "solver/base/printable.hpp"

namespace drape::results {
namespace {

constexpr std::size_t widest = 500;      ///< characters of a cell for users; CSV and JSON have all of it
constexpr std::size_t narrow_text = 24;  ///< texts are broken into lines as short as this before columns are left out,
constexpr std::size_t least_text = 8;    ///< and into shorter ones where the keys alone are too wide
constexpr std::string_view gap = "  ";

/// Columns are left out in this order.
constexpr Role dispensable[] = {Role::note,  Role::uncertainty, Role::counter, Role::quantity, Role::time,
                                Role::order, Role::error,       Role::outcome, Role::verdict};

using Lines = std::vector<std::string>;

/// Bytes of the first characters of a text.
std::size_t bytes_of_first(std::string_view text, std::size_t count) {
  std::size_t end = 0;
  while (end < text.size() && base::characters(text.substr(0, end + 1)) <= count) ++end;
  return end;
}

/// Lines of at most this width, broken after spaces, or else after what joins names, or else anywhere.
Lines broken(std::string_view text, std::size_t width) {
  Lines lines;
  while (base::characters(text) > width) {
    const std::size_t most = bytes_of_first(text, width);
    const std::size_t space = text.substr(0, most + 1).rfind(' '), joint = text.substr(0, most).find_last_of("/,-=");
    const bool at_space = space != std::string_view::npos && space > 0;
    const std::size_t end = at_space ? space : joint != std::string_view::npos ? joint + 1 : most;
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end + (at_space ? 1 : 0));
  }
  lines.emplace_back(text);
  return lines;
}

/// The longest part of a text that is not to be broken.
std::size_t longest_word(std::string_view text) {
  std::size_t longest = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    longest = std::max(longest, base::characters(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return longest;
}

Lines texts_of(const Column& column) {
  Lines texts = column.shown;
  if (texts.empty())
    for (const Datum& cell : column.cells) texts.push_back(to_text(cell, "{:.4g}"));
  for (std::string& text : texts) text = base::shortened(base::printable(text), widest);
  return texts;
}

std::size_t width_of(const Lines& lines) {
  return lines.empty() ? 0 : base::characters(std::ranges::max(lines, {}, base::characters));
}

/// A column as it is shown: its title, unit and texts, in lines of at most its width.
struct ShownColumn {
  explicit ShownColumn(const Column& of)
      : column(&of),
        title(base::shortened(base::printable(of.title.empty() ? of.name : of.title), widest)),
        unit(of.unit.empty() || of.unit == "1" ? "" : fmt::format("[{}]", base::printable(of.unit))),
        texts(texts_of(of)),
        width(std::max({base::characters(title), base::characters(unit), width_of(texts)})) {}

  bool is_text() const { return column->unit.empty(); }
  bool has_content() const {
    return std::ranges::any_of(texts, [](const std::string& text) { return !text.empty(); });
  }

  /// Numbers are not broken, and titles are between words only.
  std::size_t least_width(std::size_t of_text) const {
    const std::size_t body = is_text() ? std::min(of_text, width_of(texts)) : width_of(texts);
    return std::min(width, std::max({body, longest_word(title), base::characters(unit)}));
  }

  std::string aligned(const std::string& text) const {
    const std::string padding(width - base::characters(text), ' ');
    return is_text() ? text + padding : padding + text;
  }

  const Column* column;
  std::string title, unit;
  Lines texts;
  std::size_t width;
};

using ShownColumns = std::vector<ShownColumn>;

template <class Width>
std::size_t line_width(const ShownColumns& columns, Width width) {
  std::size_t sum = gap.size() * (columns.size() - 1);
  for (const ShownColumn& one : columns) sum += width(one);
  return sum;
}

/// The one to leave out first.
ShownColumns::iterator most_dispensable(ShownColumns& columns) {
  for (const bool also_first : {false, true})
    for (const Role role : dispensable) {
      const auto has_role = [=](const ShownColumn& one) { return one.column->role == role; };
      const auto last = std::ranges::find_if(columns.rbegin(), columns.rend(), has_role);
      if (last == columns.rend() || (!also_first && std::ranges::count_if(columns, has_role) < 2)) continue;
      return std::prev(last.base());
    }
  return columns.end();
}

/// Leaves columns out until the others fit. Returns the titles of those, in the order of the table.
Lines leave_out(ShownColumns& columns, std::size_t most) {
  ShownColumns left_out;
  while (line_width(columns, [](const ShownColumn& one) { return one.least_width(narrow_text); }) > most) {
    const auto next = most_dispensable(columns);
    if (next == columns.end()) break;
    left_out.push_back(std::move(*next));
    columns.erase(next);
  }
  std::ranges::sort(left_out, {}, &ShownColumn::column);
  Lines titles;
  for (const ShownColumn& one : left_out) titles.push_back(one.title);
  return titles;
}

/// Narrows columns, always the widest, to at least their least width, until the line fits.
void narrow(ShownColumns& columns, std::size_t most, std::size_t of_text) {
  const auto to_spare = [=](const ShownColumn& one) { return one.width > one.least_width(of_text) ? one.width : 0; };
  while (line_width(columns, [](const ShownColumn& one) { return one.width; }) > most) {
    const auto widest_one = std::ranges::max_element(columns, {}, to_spare);
    if (to_spare(*widest_one) == 0) break;
    --widest_one->width;
  }
}

fmt::text_style style_of(const ShownColumn& one, std::size_t row, bool row_is_good) {
  const auto good = fmt::fg(fmt::terminal_color::green), bad = fmt::fg(fmt::terminal_color::red);
  const Column& column = *one.column;
  if (column.role == Role::outcome && !one.texts[row].empty()) return is_good(column, text_in(&column, row)) ? good : bad;
  if (column.role == Role::error && !row_is_good) return bad;
  if (column.role == Role::verdict && standing(column.cells[row]) == Standing::met) return good;
  if (column.role == Role::verdict && standing(column.cells[row]) == Standing::missed) return bad;
  return {};
}

/// Appends the lines of a row: as many as its highest cell has.
template <class Cell, class Style>
void append_row(Lines& lines, const ShownColumns& columns, Cell cell, Style style) {
  std::vector<Lines> cells;
  std::size_t height = 1;
  for (const ShownColumn& one : columns) {
    cells.push_back(broken(cell(one), one.width));
    height = std::max(height, cells.back().size());
  }
  for (std::size_t k = 0; k < height; ++k) {
    std::string line;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::string text = columns[c].aligned(k < cells[c].size() ? cells[c][k] : "");
      const std::optional<fmt::text_style> drawn = style(columns[c]);
      line += fmt::format("{}{}", c == 0 ? "" : gap, drawn ? fmt::format(*drawn, "{}", text) : text);
    }
    lines.push_back(std::move(line));
  }
}

}  // namespace

std::string to_text(const Table& table, const Screen& screen) {
  if (rows(table) == 0) return "no rows\n";
  ShownColumns columns;
  for (const Column& column : table.columns)
    if (!column.title.empty() || table.for_file)
      if (ShownColumn one(column); one.has_content()) columns.push_back(std::move(one));
  if (columns.empty()) return "no columns\n";
  const Lines left_out = leave_out(columns, screen.columns);
  narrow(columns, screen.columns, narrow_text);
  narrow(columns, screen.columns, least_text);

  using Style = std::optional<fmt::text_style>;
  const auto of_head = [&](const ShownColumn&) { return screen.colours ? Style(fmt::emphasis::bold) : std::nullopt; };
  Lines lines;
  append_row(lines, columns, std::mem_fn(&ShownColumn::title), of_head);
  if (std::ranges::any_of(columns, [](const ShownColumn& one) { return !one.unit.empty(); }))
    append_row(lines, columns, std::mem_fn(&ShownColumn::unit), of_head);
  lines.emplace_back(line_width(columns, std::mem_fn(&ShownColumn::width)), '-');
  const Column* outcomes = find_column(table, Role::outcome);
  for (std::size_t row = 0; row < rows(table); ++row) {
    const bool is_right = outcomes == nullptr || is_good(*outcomes, text_in(outcomes, row));
    append_row(
        lines, columns, [=](const ShownColumn& one) { return one.texts[row]; },
        [&](const ShownColumn& one) { return screen.colours ? Style(style_of(one, row, is_right)) : std::nullopt; });
  }
  std::string text = fmt::format("{}\n", fmt::join(lines, "\n"));
  if (!left_out.empty())
    for (const std::string& line :
         broken(fmt::format("not shown: {}; --wide shows all", fmt::join(left_out, ", ")), screen.columns))
      text += line + '\n';
  return text;
}

std::string to_text(const Table& table) { return to_text(table, {}); }

}  // namespace drape::results
