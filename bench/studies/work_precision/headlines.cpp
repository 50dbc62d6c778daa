#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "bench/studies/work_precision/winners.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;

/// The quickest of ours at an error, and of SUNDIALS if it reaches it.
struct Quickest {
  std::string scene;
  double error;
  Winner ours, sundials;

  double ratio() const { return sundials.time / ours.time; }
};

std::vector<Quickest> quickest_on(const SceneRuns& scene) {
  std::vector<Quickest> all;
  for (const double error : levels(scene.problem))
    if (const Winner ours = winner(scene, &Configuration::is_ours, error))
      all.push_back({scene.problem.name, error, ours, winner(scene, &Configuration::is_sundials, error)});
  return all;
}

constexpr ColumnOf<Quickest> quickest_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&Quickest::scene>},
    {"error", "error <=", "1", "over the size of the scene", Role::key, field<&Quickest::error>},
    {"ours", "our quickest", "", "with that error", Role::note, [](const Quickest& row) -> Datum { return row.ours.name(); }},
    {"ours_ms", "time", "ms", "its median CPU time", Role::time, [](const Quickest& row) -> Datum { return row.ours.time; }},
    {"peer", "SUNDIALS, tuned", "", "its quickest with that error", Role::note,
     [](const Quickest& row) { return row.sundials ? Datum(row.sundials.name()) : Datum(); }},
    {"ratio", "slower by", "1", "time of SUNDIALS over that of our quickest", Role::time,
     [](const Quickest& row) { return row.sundials ? Datum(row.ratio()) : Datum(); }},
};

/// Quartiles of the ratios on a scene.
struct Summary {
  std::string scene;
  double least, median, largest;
  std::size_t errors;
};

std::optional<Summary> summary(const SceneRuns& scene) {
  std::vector<double> ratios;
  for (const Quickest& row : quickest_on(scene))
    if (row.sundials) ratios.push_back(row.ratio());
  if (ratios.empty()) return std::nullopt;
  return Summary{scene.problem.name, std::ranges::min(ratios), base::quantile(ratios, 0.5), std::ranges::max(ratios),
                 ratios.size()};
}

constexpr ColumnOf<Summary> summary_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&Summary::scene>},
    {"least", "least", "1", "of the ratios", Role::time, field<&Summary::least>},
    {"median", "median", "1", "of the ratios", Role::time, field<&Summary::median>},
    {"largest", "largest", "1", "of the ratios", Role::time, field<&Summary::largest>},
    {"errors", "errors", "1", "at how many of 1e-1 to 1e-7 there is a ratio", Role::time, field<&Summary::errors>},
    {"words", "", "", "the row in words", Role::note,
     [](const Summary& row) -> Datum {
       return fmt::format(
           "SUNDIALS, tuned, takes {:.2g} to {:.2g} times as long as our quickest, in the median {:.2g}, over {} errors.",
           row.least, row.largest, row.median, row.errors);
     }},
};

}  // namespace

results::Table quickest_table(const std::vector<SceneRuns>& scenes) {
  std::vector<Quickest> rows;
  for (const SceneRuns& scene : scenes) std::ranges::move(quickest_on(scene), std::back_inserter(rows));
  results::Table table = results::make_table("quickest", "Fastest configuration at each error level", quickest_columns, rows);
  table.headline = true;
  return table;
}

results::Table peers_summary_table(const std::vector<SceneRuns>& scenes) {
  std::vector<Summary> rows;
  for (const SceneRuns& scene : scenes)
    if (const auto row = summary(scene)) rows.push_back(*row);
  results::Table table =
      results::make_table("peers-summary", "How many times as long as our quickest SUNDIALS, tuned, takes with the same error",
                          summary_columns, rows);
  table.headline = true;
  results::draw(table, results::Figure::none, {{results::Part::caption, "words"}});
  return table;
}

}  // namespace drape::bench
