#include "results/analysis/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bench/commands/argument_checks.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/output.hpp"
#include "results/analysis/runs_table.hpp"
#include "results/file/run_file.hpp"
#include "results/file/validate.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"

namespace drape::bench {
namespace {

struct InspectArguments {
  std::string file;
  std::optional<int> run;
  std::string table;
  std::string format = "table";
  bool validate = false;
};

std::vector<results::Table> overview(const std::string& file) {
  std::vector<results::Table> all{results::to_table(results::read_provenance(file))};
  const std::vector<results::RunRecord> runs = results::read_runs(file);
  if (!runs.empty()) all.push_back(results::to_table(std::span(runs)));
  const std::vector<results::Table> tables = results::read_tables(file);
  if (!tables.empty()) all.push_back(results::list_of(tables));
  return all;
}

std::vector<results::Table> one_run(const std::string& file, int run) {
  const std::vector<results::RunRecord> runs = results::read_runs(file);
  if (run >= std::ssize(runs))
    throw std::invalid_argument(runs.empty() ? fmt::format("--run: {} has no runs", file)
                                             : fmt::format("--run: expected a run of {} from 000 to {}, not {}", file,
                                                           results::run_name(runs.size() - 1), run));
  return results::in_full(runs[static_cast<std::size_t>(run)]);
}

/// Its runs, if it has any, and all its tables.
std::vector<results::Table> all_tables(const std::string& file) {
  std::vector<results::Table> all = results::read_tables(file);
  const std::vector<results::RunRecord> runs = results::read_runs(file);
  if (!runs.empty()) all.insert(all.begin(), results::to_table(std::span(runs)));
  return all;
}

/// By its name, or by the first letters of it that no other has.
results::Table one_table(const std::string& file, const std::string& name) {
  std::vector<results::Table> all = all_tables(file);
  const auto exact = std::ranges::find(all, name, &results::Table::name);
  if (exact != all.end()) return std::move(*exact);
  const auto begins = [&](const results::Table& table) { return table.name.starts_with(name); };
  if (std::ranges::count_if(all, begins) == 1) return std::move(*std::ranges::find_if(all, begins));
  std::vector<std::string_view> names;
  for (const results::Table& table : all) names.push_back(table.name);
  const std::string nearest = base::nearest_name(name, names);
  throw std::invalid_argument(
      fmt::format("--table: expected a table of {} ({}), not '{}'{}", file,
                  names.empty() ? "it has none" : base::quoted(fmt::format("{}", fmt::join(names, ", "))), base::quoted(name),
                  nearest.empty() ? "" : fmt::format(" (did you mean {}?)", base::quoted(nearest))));
}

/// Prints where a file departs from the specification. Returns the exit code: 1 if it does.
int validate(const std::string& file) {
  const std::vector<std::string> deviations = results::validate(file);
  for (const std::string& deviation : deviations) fmt::print("{}\n", base::quoted(deviation));
  if (deviations.empty()) fmt::print("{} is as results/README.md specifies\n", base::printable(file));
  return deviations.empty() ? 0 : 1;
}

int inspect(const InspectArguments& a) {
  if (a.validate) return validate(a.file);
  if (!a.table.empty())
    print_table(one_table(a.file, a.table), a.format);
  else
    print_tables(a.run ? one_run(a.file, *a.run) : overview(a.file), a.format);
  return 0;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand("inspect", "show what is in a file of results");
  const auto a = std::make_shared<InspectArguments>();
  command.add_option("FILE", a->file, "HDF5 file of results")->required()->type_name("");
  CLI::Option* run =
      command.add_option("--run", a->run, "one run in full, by its number")->type_name("NNN")->check(between(0, 1000000));
  CLI::Option* table = command.add_option("--table", a->table, "one table, by its name or how that begins; runs: all runs")
                           ->type_name("NAME")
                           ->check(not_empty())
                           ->excludes(run);
  CLI::Option* csv = command.add_flag_callback(
      "--csv", [=] { a->format = "csv"; }, "as comma-separated values");
  command
      .add_flag_callback(
          "--json", [=] { a->format = "json"; }, "as JSON")
      ->excludes(csv);
  add_wide_option(command);
  command.add_flag("--validate", a->validate, "say where the file departs from its specification; then the exit code is 1")
      ->excludes(run)
      ->excludes(table);
  command.callback([=, &exit_code] { exit_code = inspect(*a); });
}

}  // namespace drape::bench
