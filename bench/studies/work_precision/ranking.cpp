#include "bench/studies/work_precision/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/studies/work_precision/winners.hpp"
#include "results/columns.hpp"
#include "solver/base/statistics.hpp"

namespace drape::bench {
namespace {

using results::ColumnOf;
using results::field;
using results::Role;

/// The methods of all scenes, in the order in which they come.
Methods methods_of(const std::vector<SceneRuns>& scenes) {
  Methods methods;
  for (const SceneRuns& scene : scenes)
    for (const Configuration& configuration : scene.configurations)
      if (configuration.is_default() && std::ranges::find(methods, configuration.by_default) == methods.end())
        methods.push_back(configuration.by_default);
  return methods;
}

/// The scenes in which any of ours reaches an error.
std::vector<const SceneRuns*> reaching(const std::vector<SceneRuns>& scenes, double error) {
  std::vector<const SceneRuns*> all;
  for (const SceneRuns& scene : scenes)
    if (resolves(scene.problem, error) && winner(scene, &Configuration::is_ours, error)) all.push_back(&scene);
  return all;
}

/// A method at an error: its ratios to the quickest of ours.
struct Rank {
  std::string_view method;
  double error;
  std::size_t scenes, reached;
  double mean = NAN, least = NAN, largest = NAN;  ///< NaN: it reaches it in none
};

Rank rank(const solver::Method& method, double error, const std::vector<const SceneRuns*>& scenes) {
  const auto is_method = [&](const Configuration& configuration) { return configuration.by_default == &method; };
  std::vector<double> ratios;
  for (const SceneRuns* scene : scenes)
    if (const Winner own = winner(*scene, is_method, error))
      ratios.push_back(own.time / winner(*scene, &Configuration::is_ours, error).time);
  Rank result{method.name, error, scenes.size(), ratios.size()};
  if (ratios.empty()) return result;
  result.mean = base::geometric_mean(ratios);
  result.least = std::ranges::min(ratios);
  result.largest = std::ranges::max(ratios);
  return result;
}

constexpr ColumnOf<Rank> rank_columns[] = {
    {"method", "method", "", "with automatic stages and linear solvers", Role::key, field<&Rank::method>},
    {"error", "error", "1", "at most", Role::key, field<&Rank::error>},
    {"scenes", "scenes", "1", "in which any of ours reaches the error", Role::quantity, field<&Rank::scenes>},
    {"reached", "reached", "1", "in which this method does", Role::time, field<&Rank::reached>},
    {"mean", "mean", "1", "geometric mean of the ratios to the quickest of ours", Role::time, field<&Rank::mean>},
    {"least", "least", "1", "of the ratios", Role::time, field<&Rank::least>},
    {"largest", "largest", "1", "of the ratios", Role::time, field<&Rank::largest>},
};

}  // namespace

results::Table ranking_table(const std::vector<SceneRuns>& scenes) {
  std::vector<Rank> ranks;
  for (const solver::Method* method : methods_of(scenes))
    for (const double error : usual_errors())
      if (const auto reached = reaching(scenes, error); !reached.empty()) ranks.push_back(rank(*method, error, reached));
  return results::make_table("ranking",
                             "Times of the methods over the quickest of ours, over all scenes: geometric mean and range",
                             rank_columns, ranks);
}

}  // namespace drape::bench
