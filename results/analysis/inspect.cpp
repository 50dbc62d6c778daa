#include "results/analysis/inspect.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <type_traits>

#include "results/analysis/runs_table.hpp"
#include "results/file/schema.hpp"
#include "results/table_builder.hpp"
#include "solver/base/statistics.hpp"

namespace drape::results {
namespace {

/// A table of names with values of any kind.
class Facts {
 public:
  Facts(std::string name, std::string description) : table_(std::move(name), std::move(description)) {}

  void add(const std::string& name, const std::string& value, const std::string& description) {
    begin(name);
    table_.text("value", "value", "its value", value);
    end("", description);
  }
  void add(const std::string& name, std::int64_t value, const std::string& unit, const std::string& description) {
    begin(name);
    table_.count("value", "value", "its value", value);
    end(unit, description);
  }
  void add(const std::string& name, double value, const std::string& unit, const std::string& description) {
    begin(name);
    table_.number("value", "value", "", "its value", value);
    end(unit, description);
  }
  Table finish() { return table_.finish(); }

 private:
  void begin(const std::string& name) {
    table_.row();
    table_.text("name", "name", "what it is", name);
  }
  void end(const std::string& unit, const std::string& description) {
    table_.text("unit", "unit", "of the number, 1 if it has none", unit);
    table_.text("description", "description", "what it means", description);
  }

  TableBuilder table_;
};

/// The members of a record that are single texts or numbers.
template <class Record>
Table members(const std::string& name, const std::string& description, const auto& fields, const Record& record) {
  Facts facts(name, description);
  for_each(fields, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(record.*field.member)>;
    const auto& value = record.*field.member;
    if constexpr (std::is_same_v<Value, double>) facts.add(field.name, value, field.unit, field.description);
    if constexpr (std::is_same_v<Value, solver::Outcome>)
      facts.add(field.name, std::string(to_string(value)), field.description);
    if constexpr (std::is_same_v<Value, std::string>)
      if (value.find('\n') == std::string::npos) facts.add(field.name, value, field.description);
  });
  return facts.finish();
}

Table scene_table(const std::string& toml) {
  TableBuilder table("scene", "the complete scene, as a TOML file would have it");
  std::istringstream lines(toml);
  for (std::string line; std::getline(lines, line);) {
    const auto equal = std::min(line.find(" = "), line.size());
    table.row();
    table.text("key", "key", "of the scene file", line.substr(0, equal));
    table.text("value", "value", "in TOML", equal == line.size() ? "" : line.substr(equal + 3));
  }
  return table.finish();
}

void add_series(TableBuilder& table, const char* name, const char* unit, const std::vector<double>& values) {
  if (values.empty()) return;
  table.row();
  table.text("series", "series", "list of numbers", name);
  table.text("unit", "unit", "of the numbers", unit);
  table.count("length", "length", "how many there are", std::ssize(values));
  table.number("first", "first", "1", "of the numbers", values.front());
  table.number("least", "least", "1", "of the numbers", base::quantile(values, 0));
  table.number("median", "median", "1", "of the numbers", base::quantile(values, 0.5));
  table.number("largest", "largest", "1", "of the numbers", base::quantile(values, 1));
  table.number("last", "last", "1", "of the numbers", values.back());
}

Table series_table(const RunRecord& run) {
  TableBuilder table("series", "series of numbers: one for each accepted step, repetition or frame");
  for_each(step_fields, [&](const auto& field) {
    std::vector<double> values;
    for (const StepRecord& step : run.steps) values.push_back(static_cast<double>(step.*field.member));
    add_series(table, field.name, field.unit, values);
  });
  add_series(table, "times_ms", "ms", run.times_ms);
  if (run.trajectory) add_series(table, "trajectory/t", "s", run.trajectory->times);
  return table.finish();
}

}  // namespace

Table to_table(const Provenance& facts) {
  Facts table("provenance", "where the results come from");
  for (const auto& [name, value, description] : facts) table.add(name, value, description);
  return table.finish();
}

Table list_of(const std::vector<Table>& tables) {
  TableBuilder list("tables", "tables of studies; --table NAME shows one");
  for (const Table& table : tables) {
    list.row();
    list.text("name", "table", "its name", table.name);
    list.count("rows", "rows", "how many there are", table.columns.empty() ? 0 : std::ssize(table.columns.front().cells));
    list.text("description", "description", "what it shows", table.description);
  }
  return list.finish();
}

std::vector<Table> in_full(const RunRecord& run) {
  std::vector<Table> tables{members("run", "one run of one method on one scene", run_fields, run), scene_table(run.scene_toml)};
  Facts parameters("parameters", "parameters of the scene and the solvers"),
      work("work", "how often each kind of work was done");
  for (const Parameter& p : run.parameters) parameters.add(p.name, p.value, p.unit, p.description);
  for (const WorkCount& w : run.work) work.add(w.name, w.count, "1", w.description);
  tables.push_back(parameters.finish());
  tables.push_back(work.finish());
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
