#include "results/file/schema_4.hpp"

#include <algorithm>
#include <initializer_list>
#include <sstream>
#include <utility>

namespace drape::results {
namespace {

bool one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// The tables of a list; any other value as it is. Older programs left a comma behind the last particle of a
/// pin.
std::vector<std::string> entries_of(std::string_view value) {
  if (!value.starts_with("[{")) return {std::string(value)};
  std::vector<std::string> entries;
  int depth = 0;
  bool in_text = false;
  for (std::size_t k = 1; k + 1 < value.size(); ++k) {
    const std::string_view rest = value.substr(k);
    if (!in_text && rest.starts_with(", ]")) k += 2;
    if (value[k] == '"') in_text = !in_text;
    if (!in_text && value[k] == '{' && depth++ == 0) entries.emplace_back();
    if (depth > 0) entries.back() += value[k];
    if (in_text && value[k] == '\\') entries.back() += value[++k];
    if (!in_text && value[k] == '}') --depth;
  }
  return entries;
}

/// "missed: not 4"
Datum worded(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto standing = standing_named(text.substr(0, colon));
  if (!standing) return text;
  constexpr std::size_t separator = 2;
  return Verdict{*standing, colon == std::string::npos ? "" : text.substr(colon + separator)};
}

/// "NOT 4"
Datum usual(const std::string& text) {
  constexpr std::string_view no = "NOT";
  if (text.find(no) != std::string::npos) {
    std::string detail = text;
    for (std::size_t place = 0; (place = detail.find(no, place)) != std::string::npos;) detail.replace(place, no.size(), "not");
    return Verdict{Standing::missed, detail};
  }
  for (const std::string_view good : {"as declared", "as in theory", "as predicted", "below", "falls with d", "swings less"})
    if (text.ends_with(good)) return Verdict{Standing::met, text};
  if (one_of(text, {"agrees", "all converge", "as wanted", "proportional", "within 10"})) return Verdict{Standing::met, text};
  if (text.starts_with("no ")) return Verdict{Standing::open, text};
  return text;
}

}  // namespace

Role usual_role(std::string_view name, std::string_view unit) {
  if (name == "outcome") return Role::outcome;
  if (name == "verdict") return Role::verdict;
  if (one_of(name, {"spread", "remark", "detail", "residual", "order"})) return Role::note;  // follow from other numbers
  if (unit.empty() || one_of(name, {"step", "n"})) return Role::key;
  if (one_of(unit, {"ms", "ns", "s/s", "GB/s", "MB"}) || one_of(name, {"wall", "exponent", "repetitions"})) return Role::time;
  if (name == "uncertainty") return Role::uncertainty;
  if (name == "fitted_order") return Role::order;
  if (one_of(name, {"updates", "cg_iterations", "steps", "factorisations", "forces", "escalations"})) return Role::counter;
  return one_of(name, {"error", "rms", "maximum", "distance"}) ? Role::error : Role::quantity;
}

Figure usual_figure(const Table& table) {
  const auto has = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::any_of(names, [&](std::string_view name) { return find_column(table, name) != nullptr; });
  };
  if (table.name.starts_with("trials: ")) return Figure::work_precision;
  if (table.name == "stability-atlas") return Figure::stability;
  if (table.name.starts_with("figure-4.3") && has({"t"})) return Figure::over_time;
  return has({"step", "n"}) && has({"error", "rms"}) && has({"order"}) ? Figure::convergence : Figure::none;
}

void move_to_first_rows(Table& curves) {
  const auto curve_of = [&](std::size_t row) {
    std::string name;
    for (const Column& column : curves.columns)
      if (column.role == Role::key && column.unit.empty()) name.append(text_in(&column, row)).append("\n");
    return name;
  };
  std::size_t first = 0;
  for (std::size_t row = 0; row < rows(curves); ++row) {
    if (curve_of(row) != curve_of(first)) first = row;
    const bool is_last = row + 1 == rows(curves) || curve_of(row + 1) != curve_of(row);
    if (!is_last || row == first) continue;
    for (Column& column : curves.columns)
      if (column.role == Role::verdict || column.role == Role::order || column.name == "spread") {
        std::swap(column.cells[first], column.cells[row]);
      }
  }
}

Datum written_verdict(const std::string& text, int version) { return version > 4 ? worded(text) : usual(text); }

std::vector<SceneValue> keys_in(const std::string& scene_toml) {
  std::vector<SceneValue> keys;
  std::istringstream lines(scene_toml);
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view equals = " = ";
    const std::size_t at = std::min(line.find(equals), line.size());
    const std::string value = at == line.size() ? "" : line.substr(at + equals.size());
    if (value == "[]") continue;
    for (const std::string& entry : entries_of(value)) keys.push_back({line.substr(0, at), entry, ""});
  }
  return keys;
}

}  // namespace drape::results
