#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bench/studies/studies.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"

/// How good is the choice of --method auto? At every error its time, choice included, over that of the quickest of our methods
/// and solvers, which a search finds with hindsight, all interleaved; and whether the error is as small as was asked for.
namespace drape::bench {
namespace auto_study {
namespace {

using results::Datum;
using results::field;
using results::Role;

/// A sheet that hangs and falls.
struct ChosenSheet {
  const char* scene;
  double damping;  ///< [N s/m]
  int n;           ///< particles a side
  bool quick = false;

  std::string name() const { return fmt::format("{} d={:g} n={}", scene, damping, n); }
  Effort effort() const { return quick ? Effort{.limits = {.seconds = 0.2}, .repetitions = 3} : Effort{}; }
};

/// The rule was made from 24 × 24 particles; its damping is among these except for 20 and 2 N s/m, which lie between.
std::vector<ChosenSheet> chosen_sheets(bool quick) {
  if (quick) return {{"hung-corners", 50, 8, true}, {"hung-edge", 0.5, 8, true}};
  std::vector<ChosenSheet> all;
  for (const char* scene : {"hung-corners", "hung-edge"}) {
    for (const double damping : {50.0, 5.0, 0.5, 0.0})
      for (const int n : {20, 40}) all.push_back({scene, damping, n});
    for (const double damping : {20.0, 2.0}) all.push_back({scene, damping, 30});
  }
  return all;
}

/// Without damping the motion soon depends on all its details, so that it ends earlier.
model::Scene scene_of_sheet(const ChosenSheet& sheet) {
  std::vector<model::Override> overrides{{"material.damping", fmt::format("{}", sheet.damping)},
                                         {"grid.n", fmt::format("{}", sheet.n)}};
  if (sheet.damping == 0) overrides.push_back({"end.time", "0.4"});
  return model::load_scene(sheet.scene, overrides);
}

bool is_chosen(const Configuration& one) { return one.name.find(" for ") != std::string::npos; }

/// The methods and solvers of ours that are searched.
std::vector<Configuration> searched_for(const ChosenSheet& sheet) {
  std::vector<Configuration> all = configurations(scene_of_sheet(sheet), sheet.quick ? Search::quick : Search::full, {});
  std::erase_if(all, [](const Configuration& one) { return !one.is_ours() || one.is_thesis(); });
  return all;
}

struct SheetRuns {
  ChosenSheet sheet;
  SceneRuns runs;
  std::size_t searched = 0;  ///< configurations before those that are chosen, one for each of levels()
};

void run_sheet(SheetRuns& one, Checkpoint& checkpoint) {
  const ChosenSheet& sheet = one.sheet;
  SceneRuns& runs = one.runs;
  const std::string name = sheet.name();
  const model::Scene scene = scene_of_sheet(sheet);
  checkpoint.begin(name);
  checkpoint.show("reference of " + name);
  runs.problem = sheet.damping == 0 ? explicit_problem(name, scene, checkpoint) : certified_problem(name, scene, checkpoint);
  runs.configurations = searched_for(sheet);
  one.searched = runs.configurations.size();
  for (const double error : levels(runs.problem)) runs.configurations.push_back(automatic(scene, error));
  runs.runs = run_all(runs.problem, runs.configurations, sheet.effort(), checkpoint);
  std::vector<Contender> who{std::not_fn(is_chosen)};
  for (std::size_t k = one.searched; k < runs.configurations.size(); ++k) who.push_back(only(runs.configurations[k]));
  checkpoint.show("timing " + name);
  time_fronts(runs.problem, who, runs.runs, sheet.effort(), checkpoint);
}

/// What was chosen for an error, and the quickest that reaches it.
struct Level {
  ChosenSheet sheet;
  double wanted = 0;
  const Configuration* chosen = nullptr;
  const ComparedRun* run = nullptr;  ///< what became of it
  Winner own, best;                  ///< its time, if it was timed

  bool reached() const { return run->counts() && run->measured.error <= wanted; }
  double ratio() const { return own && best ? own.time / best.time : NAN; }
  bool quick() const { return ratio() <= default_bar || (own && best && tie(best, own)); }
  results::Verdict verdict() const {
    if (!run->counts()) return results::check(false, "", run->reason);
    if (!reached()) return results::check(false, "", fmt::format("error {:.2g}", run->measured.error));
    return results::check(quick(), "", fmt::format("{:.2f} times as long", ratio()));
  }
};

std::vector<Level> levels_of(const SheetRuns& one) {
  std::vector<Level> all;
  const SceneRuns& runs = one.runs;
  const std::vector<double> wanted = levels(runs.problem);
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const Configuration& chosen = runs.configurations[one.searched + k];
    const auto run = std::ranges::find(runs.runs, &chosen, &ComparedRun::configuration);
    all.push_back({one.sheet, wanted[k], &chosen, &*run, winner(runs, only(chosen), INFINITY),
                   winner(runs, std::not_fn(is_chosen), wanted[k])});
  }
  return all;
}

using LevelRow = const Level&;

constexpr results::ColumnOf<Level> level_columns[] = {
    {"scene", "scene", "", "its name", Role::key, [](LevelRow row) -> Datum { return row.sheet.scene; }},
    {"damping", "d", "N s/m", "linear damping", Role::key, [](LevelRow row) -> Datum { return row.sheet.damping; }},
    {"n", "n", "1", "particles a side", Role::key, [](LevelRow row) { return results::to_datum(row.sheet.n); }},
    {"wanted", "error <=", "1", "asked for: the largest at all tenths of the end, over the size of the scene", Role::key,
     field<&Level::wanted>},
    {"chosen", "auto", "", "the method it chose, with its solvers", Role::note,
     [](LevelRow row) -> Datum { return row.chosen->name.substr(0, row.chosen->name.find(" for ")); }},
    {"step", "step", "s", "the step it chose", Role::quantity, [](LevelRow row) -> Datum { return row.run->variant().value; }},
    {"error", "error", "1", "that it reached", Role::error,
     [](LevelRow row) { return row.run->counts() ? Datum(row.run->measured.error) : Datum(); }},
    {"ms", "time", "ms", "its median CPU time, with the choice", Role::time,
     [](LevelRow row) { return row.own ? Datum(row.own.time) : Datum(); }},
    {"best", "quickest", "", "of our methods and solvers, with what controls its accuracy", Role::note,
     [](LevelRow row) -> Datum { return row.best.name(); }},
    {"best_ms", "its time", "ms", "its median CPU time", Role::time,
     [](LevelRow row) { return row.best ? Datum(row.best.time) : Datum(); }},
    {"ratio", "ratio", "1", "of the two times", Role::time,
     [](LevelRow row) { return std::isfinite(row.ratio()) ? Datum(row.ratio()) : Datum(); }},
    {"verdict", "verdict", "", "met: the error is reached within 1.5 times the quickest, or a tie", Role::verdict,
     [](LevelRow row) -> Datum { return row.verdict(); }},
};

/// How often it holds on sheets of a scene.
struct Summary {
  std::string scene;
  std::vector<double> ratios = {};
  int levels = 0, quick = 0, reached = 0;

  void add(const Level& level) {
    ++levels;
    reached += level.reached();
    quick += level.quick();
    if (std::isfinite(level.ratio())) ratios.push_back(level.ratio());
  }
};

using SummaryRow = const Summary&;

constexpr results::ColumnOf<Summary> summary_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&Summary::scene>},
    {"levels", "errors asked for", "1", "on all sheets of this scene", Role::quantity, field<&Summary::levels>},
    {"reached", "reached", "1", "of these, with an error at most as large", Role::quantity, field<&Summary::reached>},
    {"quick", "within 1.5", "1", "of these, within 1.5 times the quickest, or a tie", Role::time, field<&Summary::quick>},
    {"mean", "mean ratio", "1", "of the times, geometric", Role::time,
     [](SummaryRow row) { return row.ratios.empty() ? Datum() : Datum(base::geometric_mean(row.ratios)); }},
    {"worst", "largest", "1", "ratio of the times", Role::time,
     [](SummaryRow row) { return row.ratios.empty() ? Datum() : Datum(std::ranges::max(row.ratios)); }},
};

std::vector<results::Table> automatic_tables(const std::vector<SheetRuns>& all) {
  std::vector<Level> rows;
  std::vector<Summary> summaries;
  for (const SheetRuns& one : all) {
    if (summaries.empty() || summaries.back().scene != one.sheet.scene) summaries.push_back({one.sheet.scene});
    for (const Level& level : levels_of(one)) {
      rows.push_back(level);
      summaries.back().add(level);
    }
  }
  std::vector<results::Table> tables;
  for (const SheetRuns& one : all) tables.push_back(runs_table(one.runs));
  tables.push_back(
      results::make_table("auto", "What --method auto chooses, against the quickest with hindsight", level_columns, rows));
  tables.push_back(results::make_table("auto-summary", "How often --method auto is within 1.5 times the quickest",
                                       summary_columns, summaries));
  return tables;
}

}  // namespace
}  // namespace auto_study

std::vector<Job> automatic_study(const Question& question) {
  using namespace auto_study;
  const std::vector<ChosenSheet> list = chosen_sheets(question.quick);
  int parts = 0;
  for (const ChosenSheet& sheet : list) parts += static_cast<int>(searched_for(sheet).size() + usual_errors().size());
  return {job(
      "auto", parts, [=](Checkpoint& checkpoint) { return run_each<SheetRuns>(list, run_sheet, checkpoint); },
      automatic_tables)};
}

}  // namespace drape::bench
