#include "bench/studies/work_precision/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "bench/studies/work_precision/peers.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "reference/sundials/sundials_build.hpp"
#include "results/columns.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::to_datum;

// --- Runs ----------------------------------------------------------------------------------------------------------------

struct RunRow {
  const ComparedRun& run;
  double uncertainty;  ///< of the reference
};

constexpr ColumnOf<RunRow> run_columns[] = {
    {"code", "", "", "whose it is", Role::key,
     [](const RunRow& row) -> Datum { return std::string(to_string(row.run.configuration->code)); }},
    {"family", "", "", "ways that differ in one number", Role::key,
     [](const RunRow& row) -> Datum { return row.run.configuration->name; }},
    {"method", "", "", "ours with the program's defaults: the method", Role::key,
     [](const RunRow& row) {
       return to_datum(row.run.configuration->is_default() ? row.run.configuration->by_default->name : "");
     }},
    {"build", "", "", "how the program and SUNDIALS were built", Role::note,
     [](const RunRow&) -> Datum { return reference::sundials_build(); }},
    {"control", "", "", "the number: step [s], tolerance, or fraction of the stability limit", Role::key,
     [](const RunRow& row) -> Datum { return std::string(to_string(row.run.configuration->control)); }},
    {"value", "", "1", "its value", Role::key, [](const RunRow& row) -> Datum { return row.run.variant().value; }},
    {"outcome", "", "", "success, or why there is none", Role::outcome,
     [](const RunRow& row) -> Datum { return row.run.counts() ? "success" : row.run.reason; }},
    {"side", "", "", "whose search it is of", Role::note,
     [](const RunRow& row) -> Datum { return row.run.configuration->is_ours() ? "ours" : "SUNDIALS"; }},
    {"solvers", "", "", "of ours, whether the program chose them", Role::note,
     [](const RunRow& row) -> Datum { return row.run.configuration->is_default() ? "automatic" : ""; }},
    {"kind", "", "", "of its side, unless it is usual there", Role::note,
     [](const RunRow& row) {
       const Code code = row.run.configuration->code;
       return to_datum(code == Code::drape ? "" : to_string(code));
     }},
    {"uncertainty", "", "1", "of the reference, as the error", Role::uncertainty, field<&RunRow::uncertainty>},
    {"steps", "", "1", "steps", Role::counter, [](const RunRow& row) -> Datum { return row.run.steps; }},
    {"forces", "", "1", "evaluations of forces", Role::counter, [](const RunRow& row) -> Datum { return row.run.forces; }},
    {"factorisations", "", "1", "matrices factored", Role::counter,
     [](const RunRow& row) -> Datum { return row.run.factorisations; }},
};

using Times = const results::Measured&;

constexpr ColumnOf<results::Measured> times_columns[] = {
    {"error", "", "1", "largest distance from the reference at all tenths of the end, over the scene's size", Role::error,
     field<&results::Measured::error>},
    {"time", "", "ms", "median CPU time", Role::time, [](Times m) -> Datum { return results::quartiles(m.times).median; }},
    {"lower", "", "ms", "lower quartile", Role::time, [](Times m) -> Datum { return results::quartiles(m.times).lower; }},
    {"upper", "", "ms", "upper quartile", Role::time, [](Times m) -> Datum { return results::quartiles(m.times).upper; }},
    {"repetitions", "", "1", "times it was run for this", Role::time, [](Times m) { return to_datum(m.times.size()); }},
};

// --- What winners have in common -----------------------------------------------------------------------------------------

/// Where winners are sought.
struct Level {
  const SceneRuns* scene;
  double error;
};

constexpr ColumnOf<Level> level_columns[] = {
    {"scene", "scene", "", "its name", Role::key, [](const Level& level) -> Datum { return level.scene->problem.name; }},
    {"error", "error", "1", "at most, over the scene's size", Role::key, field<&Level::error>},
};

/// The size of the search on each side, and what part of the motion an error is.
constexpr ColumnOf<SceneRuns> search_columns[] = {
    {"our_families", "", "1", "configurations of ours that were tried", Role::quantity,
     [](const SceneRuns& scene) { return to_datum(number_of_configurations(scene, true)); }},
    {"sundials_families", "", "1", "configurations of SUNDIALS that were tried", Role::quantity,
     [](const SceneRuns& scene) { return to_datum(number_of_configurations(scene, false)); }},
    {"motion", "", "1", "largest distance from the start, over the scene's size", Role::quantity,
     [](const SceneRuns& scene) { return scene.problem.motion > 0 ? Datum(scene.problem.motion) : Datum(); }},
};

/// CPU times of one over those of another, with the interval of its uncertainty.
struct TimeRatio {
  double value;
  results::Interval interval;
};

/// Nothing unless there are both.
std::optional<TimeRatio> ratio_of(const Winner& a, const Winner& b) {
  if (!a || !b) return std::nullopt;
  return TimeRatio{a.time / b.time, results::ratio_of_medians(a.run->measured, b.run->measured)};
}

constexpr ColumnOf<TimeRatio> time_ratio_columns[] = {
    {"{}", "ratio", "1", "{}", Role::time, field<&TimeRatio::value>},
    {"{}_lower", "", "1", "its 95 % interval, by bootstrap", Role::time,
     [](const TimeRatio& ratio) -> Datum { return ratio.interval.lower; }},
    {"{}_upper", "", "1", "its 95 % interval, by bootstrap", Role::time,
     [](const TimeRatio& ratio) -> Datum { return ratio.interval.upper; }},
};

// --- Winners -------------------------------------------------------------------------------------------------------------

/// The quickest of a contender beside our best; no ratio unless there are both.
struct Rival {
  Winner winner;
  std::optional<TimeRatio> ratio = {};
  bool tied = false;
};

Rival beside(const Winner& winner, const Winner& best) {
  const auto ratio = ratio_of(winner, best);
  return {winner, ratio, ratio && tie(winner, best)};
}

results::Quartiles times_of(const Rival& one) { return results::quartiles(one.winner.run->measured.times); }

constexpr ColumnOf<Rival> winner_columns[] = {
    {"{}", "", "", "the quickest", Role::note, [](const Rival& one) -> Datum { return one.winner.name(); }},
    {"{}_ms", "{}", "ms", "its median CPU time", Role::time, [](const Rival& one) -> Datum { return times_of(one).median; }},
    {"{}_lower", "", "ms", "lower quartile of its times", Role::time,
     [](const Rival& one) -> Datum { return times_of(one).lower; }},
    {"{}_upper", "", "ms", "upper quartile of its times", Role::time,
     [](const Rival& one) -> Datum { return times_of(one).upper; }},
};

constexpr ColumnOf<Rival> tie_columns[] = {
    {"{}_tie", "", "", "whether the gap is below the noise", Role::note,
     [](const Rival& one) { return one.tied ? Datum("tie") : Datum(); }},
};

/// A contender of the table of winners.
struct WinnerGroup {
  std::string name, title;
  Contender contender;
};

std::vector<WinnerGroup> winner_groups(const DefaultChoice& usual) {
  std::vector<WinnerGroup> groups{{"defaults", "auto", &Configuration::is_default},
                                  {"usual", "usual", usual},
                                  {"explicit", "explicit", &Configuration::is_explicit},
                                  {"thesis", "thesis", &Configuration::is_thesis},
                                  {"sundials", "SUNDIALS", &Configuration::is_sundials}};
  for (const Code package : packages()) {
    const std::string name(to_string(package));
    groups.push_back({name, name, of_code(package)});
  }
  return groups;
}

struct WinnersRow {
  Level level;
  Rival ours;
  std::vector<Rival> others;  ///< one for each group
};

constexpr ColumnOf<WinnersRow> best_columns[] = {
    {"best", "our best", "", "the quickest of all that the program offers", Role::note,
     [](const WinnersRow& row) { return row.ours.winner ? Datum(row.ours.winner.name()) : Datum(); }},
};

std::vector<WinnersRow> winners_rows(const std::vector<SceneRuns>& scenes, const std::vector<WinnerGroup>& groups) {
  std::vector<WinnersRow> rows;
  for (const SceneRuns& scene : scenes)
    for (const double error : levels(scene.problem)) {
      WinnersRow& row = rows.emplace_back(WinnersRow{{&scene, error}, {winner(scene, &Configuration::is_ours, error)}, {}});
      for (const WinnerGroup& group : groups)
        row.others.push_back(beside(winner(scene, group.contender, error), row.ours.winner));
    }
  return rows;
}

/// Null where nothing reaches the error.
const Rival* if_won(const Rival& one) { return one.winner ? &one : nullptr; }

// --- One choice of each side ---------------------------------------------------------------------------------------------

/// Who is chosen at an error, and the ratios of SUNDIALS to ours.
struct Sides {
  Level level;
  Winner sundials, ours, defaults = {};
  std::optional<TimeRatio> ours_ratio = ratio_of(sundials, ours), defaults_ratio = ratio_of(sundials, defaults);
};

constexpr ColumnOf<Winner> side_columns[] = {
    {"{}", "{}", "", "the configuration with the value that is the quickest", Role::note,
     [](const Winner& winner) -> Datum { return winner.name(); }},
    {"{}_ms", "CPU", "ms", "its median CPU time", Role::time,
     [](const Winner& winner) { return winner ? Datum(winner.time) : Datum(); }},
};

constexpr ColumnOf<Sides> held_out_columns[] = {
    {"scene", "scene", "", "where it is judged", Role::key,
     [](const Sides& row) -> Datum { return row.level.scene->problem.name; }},
    {"training", "chosen on", "", "where the configurations were chosen", Role::key,
     [](const Sides& row) -> Datum { return row.level.scene->training->problem.name; }},
    {"error", "error", "1", "at most, over the scene's size", Role::key,
     [](const Sides& row) -> Datum { return row.level.error; }},
};

/// What was chosen on the scene's training, judged on it.
std::vector<Sides> held_out(const SceneRuns& scene) {
  std::vector<Sides> rows;
  for (const double error : levels(scene.problem)) {
    const auto chosen = [&](const Contender& side) {
      const Winner best = winner(*scene.training, side, error);
      return best ? winner(scene, named(best.run->configuration->name), error) : Winner{};
    };
    rows.push_back({{&scene, error},
                    chosen(&Configuration::is_sundials),
                    chosen(&Configuration::is_ours),
                    chosen(&Configuration::is_default)});
  }
  return rows;
}

void add_side(results::Table& table, const std::vector<Sides>& rows, Winner Sides::*side, std::string_view name,
              std::string_view title) {
  results::add_columns(table, side_columns, rows, [=](const Sides& row) { return &(row.*side); }, {name, title, {}});
}

void add_ratio(results::Table& table, const std::vector<Sides>& rows, std::optional<TimeRatio> Sides::*ratio,
               std::string_view name, std::string_view description) {
  results::add_columns(table, time_ratio_columns, rows, [=](const Sides& row) { return row.*ratio; }, {name, {}, description});
}

// --- Defaults ------------------------------------------------------------------------------------------------------------

constexpr ColumnOf<Score> score_columns[] = {
    {"choice", "choice", "", "a method and what controls its accuracy", Role::key,
     [](const Score& score) -> Datum { return score.choice.name(); }},
    {"cells", "cells", "1", "scenes and errors", Role::quantity,
     [](const Score& score) { return to_datum(score.ratios.size()); }},
    {"missed", "missed", "1", "of these not reached", Role::time, field<&Score::missed>},
    {"within", "within 1.5", "1", "of these at most 1.5 times our best, or tied with it", Role::time, field<&Score::within>},
    {"mean", "mean", "1", "geometric mean of the ratios to our best, those not reached as 10", Role::time,
     [](const Score& score) -> Datum { return score.mean(); }},
    {"worst", "worst", "1", "the largest", Role::time, field<&Score::worst>},
};

}  // namespace

int number_of_configurations(const SceneRuns& scene, bool ours) {
  return static_cast<int>(std::ranges::count(scene.configurations, ours, &Configuration::is_ours));
}

results::Table runs_table(const SceneRuns& scene) {
  std::vector<RunRow> rows;
  for (const ComparedRun& run : scene.runs) rows.push_back({run, scene.problem.uncertainty});
  results::Table table =
      results::make_table("trials: " + scene.problem.name, "All that was tried on " + scene.problem.name, run_columns, rows);
  results::add_columns(table, times_columns, rows,
                       [](const RunRow& row) { return row.run.measured.times.empty() ? nullptr : &row.run.measured; });
  table.timed_rows = table.for_file = true;
  using results::Part;
  draw(table, results::Figure::work_precision,
       {{Part::side, "side"},
        {Part::curve, "solvers"},
        {Part::curve, "kind"},
        {Part::x, "error"},
        {Part::y, "time"},
        {Part::lower, "lower"},
        {Part::upper, "upper"},
        {Part::detail, "family"},
        {Part::detail, "control"},
        {Part::detail, "value"},
        {Part::detail, "steps"},
        {Part::detail, "forces"},
        {Part::detail, "factorisations"},
        {Part::caption, "build"}});
  return table;
}

results::Table winners_table(const std::vector<SceneRuns>& scenes) {
  const DefaultChoice usual = usual_choice(scenes);
  const std::vector<WinnerGroup> groups = winner_groups(usual);
  const std::vector<WinnersRow> rows = winners_rows(scenes, groups);
  results::Table table{"winners",
                       fmt::format("With hindsight: the quickest at each error, and ratios to our best; "
                                   "usual: {}; auto: the best method with automatic stages and linear solvers; {}",
                                   usual.name(), reference::sundials_build()),
                       {}};
  results::add_columns(table, level_columns, rows, [](const WinnersRow& row) { return &row.level; });
  results::add_columns(table, search_columns, rows, [](const WinnersRow& row) { return row.level.scene; });
  results::add_columns(table, best_columns, rows);
  results::add_columns(table, winner_columns, rows, [](const WinnersRow& row) { return if_won(row.ours); },
                       {"ours", "ours", {}});
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const auto& [name, title, contender] = groups[k];
    const auto won = [k](const WinnersRow& row) { return if_won(row.others[k]); };
    results::add_columns(table, winner_columns, rows, won, {name, title, {}});
    const std::string ratio = name + "_ratio";
    results::add_columns(table, time_ratio_columns, rows, [k](const WinnersRow& row) { return row.others[k].ratio; },
                         {ratio, {}, "over our best"});
    results::add_columns(table, tie_columns, rows, won, {name, {}, {}});
  }
  return table;
}

std::set<std::string> named_configurations(const SceneRuns& scene) {
  std::set<std::string> names{advised_peer(), advised_ours};
  if (scene.training == nullptr) return names;
  for (const double error : levels(scene.problem))
    for (const auto side : {&Configuration::is_ours, &Configuration::is_default, &Configuration::is_sundials})
      if (const Winner best = winner(*scene.training, side, error)) names.insert(best.run->configuration->name);
  return names;
}

results::Table held_out_table(const std::vector<SceneRuns>& scenes) {
  std::vector<Sides> rows;
  for (const SceneRuns& scene : scenes)
    if (scene.training != nullptr) std::ranges::move(held_out(scene), std::back_inserter(rows));
  results::Table table =
      results::make_table("held-out",
                          fmt::format("Configurations that were the quickest on another scene, judged on this one; {}",
                                      reference::sundials_build()),
                          held_out_columns, rows);
  results::add_columns(table, search_columns, rows, [](const Sides& row) { return row.level.scene; });
  add_side(table, rows, &Sides::sundials, "sundials", "SUNDIALS");
  add_side(table, rows, &Sides::ours, "ours", "ours");
  add_ratio(table, rows, &Sides::ours_ratio, "ours_ratio", "CPU time of SUNDIALS over it");
  add_side(table, rows, &Sides::defaults, "defaults", "auto");
  add_ratio(table, rows, &Sides::defaults_ratio, "defaults_ratio", "CPU time of SUNDIALS over it");
  return table;
}

results::Table recommended_table(const std::vector<SceneRuns>& scenes) {
  std::vector<Sides> rows;
  for (const SceneRuns& scene : scenes) {
    if (scene.problem.in_metres) continue;
    for (const double error : levels(scene.problem))
      rows.push_back({{&scene, error}, winner(scene, named(advised_peer()), error), winner(scene, named(advised_ours), error)});
  }
  results::Table table{
      "recommended",
      fmt::format("One setting of each side for all: {} and {}; {}", advised_ours, advised_peer(), reference::sundials_build()),
      {}};
  results::add_columns(table, level_columns, rows, [](const Sides& row) { return &row.level; });
  add_side(table, rows, &Sides::ours, "ours", "ours");
  add_side(table, rows, &Sides::sundials, "sundials", "SUNDIALS");
  add_ratio(table, rows, &Sides::ours_ratio, "ratio", "CPU time of SUNDIALS over ours");
  return table;
}

results::Table defaults_table(const std::vector<SceneRuns>& scenes) {
  return results::make_table(
      "defaults", "Methods with automatic stages and linear solvers against our best choice, over all scenes and errors",
      score_columns, scores(scenes));
}

}  // namespace drape::bench
