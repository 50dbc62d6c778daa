#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bench/studies/studies.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"

/// Which method should one use? Of ours, with automatic stages and linear solvers, the quickest at some errors, over damping
/// and size of one sheet.
namespace drape::bench {
namespace {

using results::Datum;
using results::field;
using results::Role;

constexpr double choice_errors[] = {1e-2, 1e-4, 1e-6};

/// A sheet hung by two corners.
struct HungSheet {
  double damping;  ///< [N s/m]: 50 strong, 5 weak, 0.5 little
  int n;           ///< particles a side
  bool quick;

  Search search() const { return quick ? Search::quick : Search::usual; }
  Effort effort() const { return quick ? Effort{.limits = {.seconds = 0.1}, .repetitions = 3} : Effort{}; }
};

std::string name_of_sheet(const HungSheet& sheet) { return fmt::format("hung-corners d={:g} n={}", sheet.damping, sheet.n); }

std::vector<HungSheet> hung_sheets_to_choose_on(bool quick) {
  if (quick) return {{50, 5, true}, {0.5, 5, true}};
  std::vector<HungSheet> all;
  for (const double damping : {50.0, 5.0, 0.5})
    for (const int n : {10, 30}) all.push_back({damping, n, false});
  return all;
}

model::Scene hung_scene(const HungSheet& sheet) {
  std::vector<model::Override> overrides{{"material.damping", fmt::format("{}", sheet.damping)},
                                         {"grid.n", fmt::format("{}", sheet.n)}};
  if (sheet.quick) overrides.push_back({"end.time", "0.1"});
  return model::load_scene("hung-corners", overrides);
}

/// Our methods with automatic stages and linear solvers.
std::vector<Configuration> default_configurations(const HungSheet& sheet) {
  std::vector<Configuration> all = configurations(hung_scene(sheet), sheet.search(), {});
  std::erase_if(all, [](const Configuration& one) { return !one.is_default(); });
  return all;
}

/// A sheet with all that was run on it.
struct SheetRuns {
  HungSheet sheet;
  SceneRuns scene;
};

void run_defaults(SheetRuns& runs, Checkpoint& checkpoint) {
  SceneRuns& scene = runs.scene;
  const std::string name = name_of_sheet(runs.sheet);
  checkpoint.begin(name);
  checkpoint.show("reference of " + name);
  scene.problem = certified_problem(name, hung_scene(runs.sheet), checkpoint);
  scene.problem.enough = std::ranges::min(choice_errors);
  scene.configurations = default_configurations(runs.sheet);
  scene.runs = run_all(scene.problem, scene.configurations, runs.sheet.effort(), checkpoint);
  checkpoint.show("timing " + name);
  time_fronts(scene.problem, scene.runs, runs.sheet.effort(), {}, checkpoint);
}

/// The quickest at an error, and the quickest of the other methods.
struct Choice {
  HungSheet sheet;
  double error;
  Winner best, runner_up;

  std::optional<results::Quartiles> times() const {
    return best ? std::optional(results::quartiles(best.run->measured.times)) : std::nullopt;
  }
  std::optional<results::Interval> ratio_interval() const {
    if (!runner_up) return std::nullopt;
    return results::ratio_of_medians(runner_up.run->measured, best.run->measured);
  }
};

Choice choose(const SheetRuns& runs, double error) {
  Choice choice{runs.sheet, error, winner(runs.scene, &Configuration::is_default, error), {}};
  if (!choice.best) return choice;
  const solver::Method* best = choice.best.run->configuration->by_default;
  const auto other = [best](const Configuration& one) { return one.is_default() && one.by_default != best; };
  choice.runner_up = winner(runs.scene, other, error);
  return choice;
}

using ChoiceRow = const Choice&;

constexpr results::ColumnOf<Choice> choice_columns[] = {
    {"damping", "d", "N s/m", "linear damping", Role::key, [](ChoiceRow row) -> Datum { return row.sheet.damping; }},
    {"n", "n", "1", "particles a side", Role::key, [](ChoiceRow row) { return results::to_datum(row.sheet.n); }},
    {"error", "error <=", "1", "the largest at all tenths of the end, over the size of the scene", Role::key,
     field<&Choice::error>},
    {"best", "quickest", "", "a method, what controls its accuracy, and the value of that; none if no method is so accurate",
     Role::note, [](ChoiceRow row) -> Datum { return row.best.name(); }},
    {"ms", "time", "ms", "its median CPU time", Role::time,
     [](ChoiceRow row) { return row.best ? Datum(row.best.time) : Datum(); }},
    {"lower", "from", "ms", "lower quartile of its times", Role::time,
     [](ChoiceRow row) { return row.best ? Datum(row.times()->lower) : Datum(); }},
    {"upper", "to", "ms", "upper quartile of its times", Role::time,
     [](ChoiceRow row) { return row.best ? Datum(row.times()->upper) : Datum(); }},
    {"runner_up", "runner-up", "", "the quickest of the other methods", Role::note,
     [](ChoiceRow row) { return row.runner_up ? Datum(row.runner_up.name()) : Datum(); }},
    {"ratio", "slower by", "1", "time of the runner-up over that of the quickest", Role::time,
     [](ChoiceRow row) { return row.runner_up ? Datum(row.runner_up.time / row.best.time) : Datum(); }},
    {"ratio_lower", "", "1", "its 95 % interval, by bootstrap", Role::time,
     [](ChoiceRow row) { return row.runner_up ? Datum(row.ratio_interval()->lower) : Datum(); }},
    {"ratio_upper", "", "1", "its 95 % interval, by bootstrap", Role::time,
     [](ChoiceRow row) { return row.runner_up ? Datum(row.ratio_interval()->upper) : Datum(); }},
};

results::Table choice_table(const std::vector<SheetRuns>& all) {
  std::vector<Choice> rows;
  for (const SheetRuns& runs : all)
    for (const double error : choice_errors) rows.push_back(choose(runs, error));
  return results::make_table("choice", "The quickest of our methods with automatic stages and linear solvers", choice_columns,
                             rows);
}

std::vector<results::Table> choice_tables(const std::vector<SheetRuns>& all) {
  std::vector<results::Table> tables;
  for (const SheetRuns& runs : all) tables.push_back(runs_table(runs.scene));
  tables.push_back(choice_table(all));
  return tables;
}

}  // namespace

std::vector<Job> choice(const Question& question) {
  const std::vector<HungSheet> list = hung_sheets_to_choose_on(question.quick);
  int parts = 0;
  for (const HungSheet& sheet : list) parts += static_cast<int>(default_configurations(sheet).size());
  return {job(
      "choice", parts, [=](Checkpoint& checkpoint) { return run_each<SheetRuns>(list, run_defaults, checkpoint); },
      choice_tables)};
}

}  // namespace drape::bench
