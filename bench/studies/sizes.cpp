#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/studies/studies.hpp"
#include "bench/studies/work_precision/winners.hpp"
#include "bench/studies/work_precision/work_precision.hpp"
#include "model/garment.hpp"
#include "model/scene_file/scene_file.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"

/// Does a sheet of 20 × 20 particles mislead? The quickest of ours and of SUNDIALS at every error on sheets of all sizes and on
/// two garments, and what it costs to take the method that is the quickest on the small sheet.
namespace drape::bench {
namespace size_study {
namespace {

using results::Datum;
using results::field;
using results::Role;

/// A sheet hung by two corners, or a garment that hangs, without a body.
struct SizedCloth {
  std::string name;
  std::string smallest;  ///< the name of the sheet whose choice is tried here, of the same stiffness and damping
  model::Scene scene;
  Search search = Search::full;
  Effort effort = {};
  std::string smaller = {};  ///< the name of the sheet half as large: only what is quick there is tried here
  std::size_t few = 3;       ///< how many of each side that are quick there, at each error
  bool stepped = false;      ///< whether its truth is of ever shorter steps: certificates would take hours
};

std::string name_of_sheet(double damping, int n) { return fmt::format("hung-corners d={:g} n={}", damping, n); }

SizedCloth sheet(double damping, int n, int smallest, bool quick) {
  std::vector<model::Override> overrides{{"material.damping", fmt::format("{}", damping)}, {"grid.n", fmt::format("{}", n)}};
  if (quick) overrides.push_back({"end.time", "0.1"});
  SizedCloth all{name_of_sheet(damping, n), name_of_sheet(damping, smallest), model::load_scene("hung-corners", overrides)};
  const double longer = damping < 1 ? 3 : 1;  // for explicit methods, the quickest there, whose time goes with n³
  all.effort.limits.seconds = std::max(1.0, longer * n * n / 6400.0);
  all.stepped = n > (quick ? 8 : 100);
  if (n > smallest) all.smaller = name_of_sheet(damping, n / 2);
  if (n > 200) all.few = 1;
  if (all.stepped) all.effort.repetitions = 3;
  if (quick) all.search = Search::quick, all.effort = {.limits = {.seconds = 0.1}, .repetitions = 3};
  return all;
}

SizedCloth garment(const char* name, std::string smallest, std::vector<model::Override> overrides) {
  overrides.insert(overrides.end(), {{"obstacles", "[]"}, {"end.time", "0.5"}});
  return {.name = name, .smallest = std::move(smallest), .scene = model::load_scene(name, overrides)};
}

std::vector<SizedCloth> sized_cloths(bool quick) {
  std::vector<SizedCloth> all;
  const int smallest = quick ? 5 : 20;
  for (const double damping : quick ? std::vector{50.0} : std::vector{50.0, 5.0, 0.5}) {
    const int largest = quick ? 10 : damping < 1 ? 160 : 320;  // the truth of 320 with d = 0.5 would take hours
    for (int n = smallest; n <= largest; n *= 2) all.push_back(sheet(damping, n, smallest, quick));
  }
  if (quick) return all;
  all.push_back(garment("skirt", name_of_sheet(5, smallest), {}));
  all.push_back(garment("dress", name_of_sheet(50, smallest),
                        {{"pins",
                          "[{ panel = 'right strap', particles = [[5, 1], [6, 1]] }, "
                          "{ panel = 'left strap', particles = [[5, 1], [6, 1]] }]"}}));
  return all;
}

std::vector<Configuration> searched_for(const SizedCloth& cloth) {
  std::vector<Configuration> all = configurations(cloth.scene, cloth.search, {});
  std::erase_if(all, &Configuration::is_thesis);
  return all;
}

struct ClothRuns {
  SizedCloth cloth;
  SceneRuns runs;
};

/// Adds the names of the quickest configurations of a side, ours or SUNDIALS, at an error.
void add_quickest(std::set<std::string>& names, const SceneRuns& runs, const Contender& side, double error, std::size_t few) {
  std::set<std::string> added;
  while (added.size() < few) {
    const Winner next = winner(
        runs, [&](const Configuration& one) { return side(one) && !added.contains(one.name); }, error);
    if (!next) break;
    added.insert(next.run->configuration->name);
  }
  names.merge(added);
}

/// The quickest of ours with automatic solvers, and what controls it.
DefaultChoice quickest_choice(const SceneRuns& scene, double error) {
  const Winner best = winner(scene, &Configuration::is_default, error);
  return best ? DefaultChoice{best.run->configuration->by_default, best.run->configuration->control} : DefaultChoice{};
}

/// The runs of cloths that others follow, by name.
using RunsByName = std::map<std::string, const SceneRuns*>;

/// The names of what is worth its time on a cloth: at any error among the quickest on the sheet half as large, or the choice of
/// the smallest sheet.
std::set<std::string> worth_trying(const RunsByName& done, const SizedCloth& cloth) {
  const SceneRuns &smaller = *done.at(cloth.smaller), &smallest = *done.at(cloth.smallest);
  std::set<std::string> names;
  for (const double error : levels(smaller.problem))
    for (const Contender& side : {Contender(&Configuration::is_ours), Contender(&Configuration::is_sundials)})
      add_quickest(names, smaller, side, error, cloth.few);
  for (const double error : levels(smallest.problem))
    if (const Winner choice = winner(smallest, &Configuration::is_default, error))
      names.insert(choice.run->configuration->name);
  return names;
}

void run_cloth(const SizedCloth& cloth, SceneRuns& runs, const RunsByName& done, Checkpoint& checkpoint) {
  checkpoint.begin(cloth.name);
  checkpoint.show("reference of " + cloth.name);
  runs.problem = (cloth.stepped ? stepped_problem : certified_problem)(cloth.name, cloth.scene, checkpoint);
  runs.configurations = searched_for(cloth);
  if (!cloth.smaller.empty()) {
    const std::set<std::string> names = worth_trying(done, cloth);
    std::erase_if(runs.configurations, [&](const Configuration& one) { return !names.contains(one.name); });
  }
  runs.runs = run_all(runs.problem, runs.configurations, cloth.effort, checkpoint);
  checkpoint.show("timing " + cloth.name);
  time_fronts(runs.problem, runs.runs, cloth.effort, {}, checkpoint);
}

std::vector<ClothRuns> run_cloths(const std::vector<SizedCloth>& list, Checkpoint& checkpoint) {
  std::vector<ClothRuns> all;
  all.reserve(list.size());  // runs point into what is in it
  RunsByName done;
  checkpoint.each(list, [&](const SizedCloth& cloth) {
    if (!cloth.smaller.empty() && !done.contains(cloth.smaller)) throw ComputedElsewhere();
    SceneRuns& runs = all.emplace_back(ClothRuns{cloth, {}}).runs;
    run_cloth(cloth, runs, done, checkpoint);
    done[cloth.name] = &runs;
  });
  return all;
}

/// A cloth at an error.
struct Level {
  const SizedCloth* cloth;
  int particles;
  double error;
  Winner best, sundials, as_small;
  DefaultChoice small_choice;

  std::optional<double> ratio() const { return best && sundials ? std::optional(sundials.time / best.time) : std::nullopt; }
  std::optional<results::Interval> interval() const {
    return ratio() ? std::optional(results::ratio_of_medians(sundials.run->measured, best.run->measured)) : std::nullopt;
  }
  std::optional<double> misled() const { return best && as_small ? std::optional(as_small.time / best.time) : std::nullopt; }
};

std::vector<Level> levels_of(const std::vector<ClothRuns>& all) {
  std::vector<Level> rows;
  for (const ClothRuns& one : all) {
    const auto small =
        std::ranges::find_if(all, [&](const ClothRuns& other) { return other.cloth.name == one.cloth.smallest; });
    for (const double error : levels(one.runs.problem)) {
      const DefaultChoice choice = quickest_choice(small->runs, error);
      rows.push_back({&one.cloth, model::nodes(one.cloth.scene), error, winner(one.runs, &Configuration::is_ours, error),
                      winner(one.runs, &Configuration::is_sundials, error),
                      choice.method != nullptr ? winner(one.runs, choice, error) : Winner{}, choice});
    }
  }
  return rows;
}

using LevelRow = const Level&;

constexpr results::ColumnOf<Level> level_columns[] = {
    {"cloth", "cloth", "", "a sheet with its damping [N s/m] and particles a side, or a garment", Role::key,
     [](LevelRow row) -> Datum { return row.cloth->name; }},
    {"particles", "particles", "1", "in all", Role::quantity, field<&Level::particles>},
    {"error", "error <=", "1", "the largest at all tenths of the end, over the size of the scene", Role::key,
     field<&Level::error>},
    {"best", "our quickest", "", "with what controls its accuracy", Role::note,
     [](LevelRow row) -> Datum { return row.best.name(); }},
    {"ms", "time", "ms", "its median CPU time, set-up included", Role::time,
     [](LevelRow row) { return row.best ? Datum(row.best.time) : Datum(); }},
    {"sundials", "SUNDIALS, tuned", "", "the quickest configuration of its packages", Role::note,
     [](LevelRow row) -> Datum { return row.sundials.name(); }},
    {"ratio", "slower by", "1", "its time over that of our quickest", Role::time,
     [](LevelRow row) { return row.ratio() ? Datum(*row.ratio()) : Datum(); }},
    {"ratio_lower", "from", "1", "of the ratio, 95 % by bootstrap", Role::time,
     [](LevelRow row) { return row.interval() ? Datum(row.interval()->lower) : Datum(); }},
    {"ratio_upper", "to", "1", "of the ratio, 95 % by bootstrap", Role::time,
     [](LevelRow row) { return row.interval() ? Datum(row.interval()->upper) : Datum(); }},
    {"small", "quickest when small", "", "of ours with automatic solvers on the smallest sheet of this damping", Role::note,
     [](LevelRow row) -> Datum { return row.small_choice.name(); }},
    {"misled", "slower by", "1", "its time on this cloth over that of our quickest; none if it does not reach the error",
     Role::time, [](LevelRow row) { return row.misled() ? Datum(*row.misled()) : Datum(); }},
};

/// All errors on a cloth.
struct Summary {
  std::string name;
  int errors = 0, twice = 0, misleads = 0;
  std::vector<double> ratios = {}, misled = {};
};

using SummaryRow = const Summary&;

constexpr results::ColumnOf<Summary> summary_columns[] = {
    {"cloth", "cloth", "", "as in the table before", Role::key, field<&Summary::name>},
    {"errors", "errors", "1", "that its truth resolves", Role::quantity, field<&Summary::errors>},
    {"least", "SUNDIALS least", "1", "least ratio of its time to ours", Role::time,
     [](SummaryRow row) { return row.ratios.empty() ? Datum() : Datum(std::ranges::min(row.ratios)); }},
    {"median", "median", "1", "ratio of its time to ours", Role::time,
     [](SummaryRow row) { return row.ratios.empty() ? Datum() : Datum(base::quantile(row.ratios, 0.5)); }},
    {"twice", "from 2 on", "1", "errors where SUNDIALS takes at least twice our time", Role::time, field<&Summary::twice>},
    {"misleads", "misled", "1",
     "errors where the small sheet's choice takes more than 1.5 times our quickest, or misses what that reaches", Role::time,
     field<&Summary::misleads>},
    {"mean", "mean loss", "1", "geometric mean of that choice's time over our quickest", Role::time,
     [](SummaryRow row) { return row.misled.empty() ? Datum() : Datum(base::geometric_mean(row.misled)); }},
};

std::vector<Summary> summaries_of(const std::vector<Level>& levels) {
  std::vector<Summary> all;
  for (const Level& level : levels) {
    if (all.empty() || all.back().name != level.cloth->name) all.push_back({level.cloth->name});
    Summary& of_cloth = all.back();
    ++of_cloth.errors;
    of_cloth.twice += level.ratio().value_or(0) >= 2;
    if (level.small_choice.method != nullptr && level.best)
      of_cloth.misleads += level.misled().value_or(INFINITY) > default_bar;
    if (level.ratio()) of_cloth.ratios.push_back(*level.ratio());
    if (level.misled()) of_cloth.misled.push_back(*level.misled());
  }
  return all;
}

std::vector<results::Table> tables_of(const std::vector<ClothRuns>& all) {
  std::vector<results::Table> tables;
  for (const ClothRuns& one : all) tables.push_back(runs_table(one.runs));
  const std::vector<Level> levels = levels_of(all);
  tables.push_back(results::make_table("size-levels", "The quickest at each error, by size", level_columns, levels));
  tables.push_back(
      results::make_table("size", "Whether small sheets mislead, and SUNDIALS at size", summary_columns, summaries_of(levels)));
  return tables;
}

}  // namespace
}  // namespace size_study

std::vector<Job> sizes(const Question& question) {
  using namespace size_study;
  const std::vector<SizedCloth> list = sized_cloths(question.quick);
  int parts = 0;
  for (const SizedCloth& cloth : list) parts += static_cast<int>(searched_for(cloth).size());
  return {job(
      "size", parts, [=](Checkpoint& checkpoint) { return run_cloths(list, checkpoint); }, tables_of)};
}

}  // namespace drape::bench
