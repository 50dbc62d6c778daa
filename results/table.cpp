#include "results/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <variant>

#include "solver/outcome.hpp"

namespace drape::results {
namespace {

/// What one run has in one column; monostate if it has no value.
using Cell = std::variant<std::monostate, std::string, double, std::int64_t>;

struct Column {
  std::string_view name;   ///< in CSV and JSON
  std::string_view title;  ///< for people; empty if not shown to them
  std::string_view unit;   ///< empty for text
  Cell (*cell)(const RunRecord&);
};

/// The time below which a share of the repetitions is: 0 minimum, 0.5 median, 1 maximum; interpolated between two times.
Cell quantile(const RunRecord& run, double share) {
  if (run.times_ms.empty()) return {};
  std::vector<double> sorted = run.times_ms;
  std::ranges::sort(sorted);
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

template <class Value>
Cell of_error(const RunRecord& run, Value ErrorRecord::*member) {
  return run.error ? Cell((*run.error).*member) : Cell();
}

using Run = const RunRecord&;
constexpr Column columns[] = {
    {"scene", "scene", "", [](Run run) -> Cell { return run.scene; }},
    {"method", "method", "", [](Run run) -> Cell { return run.method; }},
    {"step", "step", "s", [](Run run) -> Cell { return run.step; }},
    {"outcome", "", "", [](Run run) -> Cell { return run.outcome; }},
    {"message", "", "", [](Run run) -> Cell { return run.message; }},
    {"steps", "steps", "1", [](Run run) -> Cell { return std::ssize(run.steps); }},
    {"updates", "updates", "1", [](Run run) -> Cell { return work_count(run, "updates"); }},
    {"cg_iterations", "CG", "1", [](Run run) -> Cell { return work_count(run, "cg_iterations"); }},
    {"wall_ms_min", "wall min", "ms", [](Run run) { return quantile(run, 0); }},
    {"wall_ms_median", "median", "ms", [](Run run) { return quantile(run, 0.5); }},
    {"wall_ms_max", "max", "ms", [](Run run) { return quantile(run, 1); }},
    {"error_rms", "rms error", "1", [](Run run) { return of_error(run, &ErrorRecord::rms); }},
    {"reference", "reference", "", [](Run run) { return of_error(run, &ErrorRecord::reference); }},
    {"reference_error", "its error", "1", [](Run run) { return of_error(run, &ErrorRecord::reference_error); }},
    {"error_max", "", "1", [](Run run) { return of_error(run, &ErrorRecord::maximum); }},
    {"numerical_stiffness", "ν_h", "1", [](Run run) -> Cell { return run.numerical_stiffness; }},
    {"stiffness_to_damping", "h k/d", "1", [](Run run) -> Cell { return run.stiffness_to_damping; }},
    {"last_good_time", "", "s", [](Run run) -> Cell { return run.last_good_time; }},
    {"set", "set", "", [](Run run) -> Cell { return run.overrides; }},
};

/// Calls the function for the alternative that a cell holds.
template <class... Functions>
struct Overload : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overload(Functions...) -> Overload<Functions...>;

/// `number` is a format for doubles: "{}" gives the shortest text that reads back as the same number.
std::string to_text(const Cell& cell, std::string_view number) {
  return std::visit(Overload{[](std::monostate) { return std::string(); }, [](const std::string& text) { return text; },
                             [&](double value) { return fmt::format(fmt::runtime(number), value); },
                             [](std::int64_t value) { return std::to_string(value); }},
                    cell);
}

nlohmann::ordered_json to_value(const Cell& cell) {
  return std::visit(Overload{[](std::monostate) { return nlohmann::ordered_json(); },
                             [](const auto& value) { return nlohmann::ordered_json(value); }},
                    cell);
}

std::string quoted(std::string text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  for (auto at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2)) text.insert(at, 1, '"');
  return '"' + text + '"';
}

/// What people see: why there is no error, and no digits of an error that the reference is too uncertain to resolve.
std::string shown(const Column& column, const RunRecord& run) {
  constexpr double resolved = 10;  // times the reference's own error
  if (column.name == "error_rms") {
    if (run.outcome != to_string(solver::Outcome::success))
      return fmt::format("{} at {:.4g} s", run.outcome, run.last_good_time);
    if (run.error && run.error->rms < resolved * run.error->reference_error)
      return fmt::format("< {:.1g}", resolved * run.error->reference_error);
  }
  return to_text(column.cell(run), "{:.4g}");
}

/// Characters of UTF-8 text: all bytes but those that continue one.
std::size_t display_width(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](unsigned char byte) { return (byte & 0xC0) != 0x80; }));
}

/// Appends one cell to each line: text to the left of the column, numbers to the right.
void append_column(std::vector<std::string>& lines, const std::vector<std::string>& cells, bool is_text) {
  const std::size_t width = display_width(std::ranges::max(cells, {}, display_width));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string padding(width - display_width(cells[i]), ' ');
    if (!lines[i].empty()) lines[i] += "  ";
    lines[i] += is_text ? cells[i] + padding : padding + cells[i];
  }
}

}  // namespace

std::string to_table(std::span<const RunRecord> runs) {
  std::vector<std::string> lines(runs.size() + 2);
  for (const Column& column : columns) {
    const bool has_unit = !column.unit.empty() && column.unit != "1";
    std::vector<std::string> cells{std::string(column.title), has_unit ? fmt::format("[{}]", column.unit) : ""};
    for (const RunRecord& run : runs) cells.push_back(shown(column, run));
    const bool nothing =
        !runs.empty() && std::all_of(cells.begin() + 2, cells.end(), [](const auto& cell) { return cell.empty(); });
    if (!column.title.empty() && !nothing) append_column(lines, cells, column.unit.empty());
  }
  lines.insert(lines.begin() + 2, std::string(display_width(lines.front()), '-'));
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

std::string to_csv(std::span<const RunRecord> runs) {
  std::string csv;
  for (const Column& column : columns) csv += fmt::format("{}{}", csv.empty() ? "" : ",", column.name);
  for (const RunRecord& run : runs) {
    std::string_view separator = "\n";
    for (const Column& column : columns) {
      csv += fmt::format("{}{}", separator, quoted(to_text(column.cell(run), "{}")));
      separator = ",";
    }
  }
  return csv + "\n";
}

std::string to_json(std::span<const RunRecord> runs) {
  auto list = nlohmann::ordered_json::array();
  for (const RunRecord& run : runs) {
    auto& object = list.emplace_back();
    for (const Column& column : columns) object[std::string(column.name)] = to_value(column.cell(run));
  }
  // Messages may quote bytes that are not UTF-8, which JSON cannot hold.
  return list.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace drape::results
