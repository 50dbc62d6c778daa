#include "results/analysis/inspect.hpp"

#include <iterator>
#include <type_traits>

#include "results/columns.hpp"
#include "results/file/schema.hpp"
#include "solver/base/statistics.hpp"

namespace drape::results {
namespace {

/// A name with a value of any kind.
struct NamedValue {
  std::string name;
  Datum value;
  std::string unit, description;
};

constexpr const char* of_name = "what it is";
constexpr const char* of_value = "its value";
constexpr const char* of_unit = "of the number, 1 if it has none";
constexpr const char* of_description = "what it means";

constexpr ColumnOf<NamedValue> value_columns[] = {
    {"name", "name", "", of_name, Role::key, field<&NamedValue::name>},
    {"value", "value", "", of_value, Role::note, [](const NamedValue& named) { return named.value; }},
    {"unit", "unit", "", of_unit, Role::note, field<&NamedValue::unit>},
    {"description", "description", "", of_description, Role::note, field<&NamedValue::description>},
};

constexpr ColumnOf<Fact> fact_columns[] = {
    {"name", "name", "", of_name, Role::key, field<&Fact::name>},
    {"value", "value", "", of_value, Role::note, field<&Fact::value>},
    {"unit", "unit", "", of_unit, Role::note, [](const Fact&) { return to_datum(""); }},
    {"description", "description", "", of_description, Role::note, field<&Fact::description>},
};

constexpr ColumnOf<Parameter> parameter_columns[] = {
    {"name", "name", "", of_name, Role::key, field<&Parameter::name>},
    {"value", "value", "", of_value, Role::quantity, field<&Parameter::value>},
    {"unit", "unit", "", of_unit, Role::note, field<&Parameter::unit>},
    {"description", "description", "", of_description, Role::note, field<&Parameter::description>},
};

constexpr ColumnOf<WorkCount> work_columns[] = {
    {"name", "name", "", of_name, Role::key, field<&WorkCount::name>},
    {"value", "value", "1", of_value, Role::counter, field<&WorkCount::count>},
    {"unit", "unit", "", of_unit, Role::note, [](const WorkCount&) { return to_datum("1"); }},
    {"description", "description", "", of_description, Role::note, field<&WorkCount::description>},
};

/// The members of a record that are single texts or numbers.
template <class Record>
Table members(std::string name, std::string description, const auto& fields, const Record& record) {
  std::vector<NamedValue> rows;
  for_each(fields, [&](const auto& member) {
    using Value = std::remove_cvref_t<decltype(record.*member.member)>;
    const auto& value = record.*member.member;
    if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, solver::Outcome>)
      rows.push_back({member.name, to_datum(value), member.unit, member.description});
    if constexpr (std::is_same_v<Value, std::string>)
      if (value.find('\n') == std::string::npos) rows.push_back({member.name, value, "", member.description});
  });
  return make_table(std::move(name), std::move(description), value_columns, rows);
}

constexpr ColumnOf<SceneValue> scene_columns[] = {
    {"key", "key", "", "of the scene file", Role::key, field<&SceneValue::key>},
    {"value", "value", "", "in TOML", Role::note, field<&SceneValue::value>},
    {"unit", "unit", "", "of the value, 1 if it has none; empty: not a number", Role::note, field<&SceneValue::unit>},
};

/// At least one number.
struct Series {
  std::string name, unit;
  std::vector<double> values;
};

Datum quantile_of(const Series& series, double share) { return base::quantile(series.values, share); }

constexpr const char* of_numbers = "of the numbers";

constexpr ColumnOf<Series> series_columns[] = {
    {"series", "series", "", "list of numbers", Role::key, field<&Series::name>},
    {"unit", "unit", "", of_numbers, Role::note, field<&Series::unit>},
    {"length", "length", "1", "how many there are", Role::quantity,
     [](const Series& series) -> Datum { return std::ssize(series.values); }},
    {"first", "first", "1", of_numbers, Role::quantity, [](const Series& series) -> Datum { return series.values.front(); }},
    {"least", "least", "1", of_numbers, Role::quantity, [](const Series& series) { return quantile_of(series, 0); }},
    {"median", "median", "1", of_numbers, Role::quantity, [](const Series& series) { return quantile_of(series, 0.5); }},
    {"largest", "largest", "1", of_numbers, Role::quantity, [](const Series& series) { return quantile_of(series, 1); }},
    {"last", "last", "1", of_numbers, Role::quantity, [](const Series& series) -> Datum { return series.values.back(); }},
};

Table series_table(const RunRecord& run) {
  std::vector<Series> rows;
  for_each(step_fields, [&](const auto& member) {
    Series& series = rows.emplace_back(Series{member.name, member.unit, {}});
    for (const StepRecord& step : run.steps) series.values.push_back(static_cast<double>(step.*member.member));
  });
  rows.push_back({"times_ms", "ms", run.times_ms});
  if (run.trajectory) rows.push_back({"trajectory/t", "s", run.trajectory->times});
  std::erase_if(rows, [](const Series& series) { return series.values.empty(); });
  return make_table("series", "series of numbers: one for each accepted step, repetition or frame", series_columns, rows);
}

constexpr ColumnOf<Table> table_columns[] = {
    {"name", "table", "", "its name", Role::key, field<&Table::name>},
    {"rows", "rows", "1", "how many there are", Role::quantity, [](const Table& table) { return to_datum(rows(table)); }},
    {"description", "description", "", "what it shows", Role::note, field<&Table::description>},
};

}  // namespace

Table to_table(const Provenance& facts) { return make_table("provenance", "where the results come from", fact_columns, facts); }

Table list_of(const std::vector<Table>& tables) {
  return make_table("tables", "tables of studies; --table NAME shows one", table_columns, tables);
}

std::vector<Table> in_full(const RunRecord& run) {
  std::vector<Table> tables{
      members("run", "one run of one method on one scene", run_fields, run),
      make_table("scene", "the complete scene, key by key", scene_columns, run.scene_keys),
      make_table("parameters", "parameters of the scene and the solvers", parameter_columns, run.parameters),
      make_table("work", "how often each kind of work was done", work_columns, run.work)};
  if (run.choice) tables.push_back(members("choice", "why the program chose method and step", choice_fields, *run.choice));
  if (run.error)
    tables.push_back(members("error", "distance of the final positions from a reference", error_fields, *run.error));
  if (run.motion_error)
    tables.push_back(
        members("motion_error", "largest distances from a reference during the run", motion_error_fields, *run.motion_error));
  if (run.contact) tables.push_back(members("contact", "what obstacles did", contact_fields, *run.contact));
  tables.push_back(series_table(run));
  return tables;
}

}  // namespace drape::results
