#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>

#include "bench/studies/references_growth.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

constexpr double reference_rtol = 1e-10;
constexpr double closest = 1e-8;  ///< of the size of the scene
constexpr int outputs = 10;

const std::vector<std::string> family_names{"cvode-bdf", "arkode-esdirk", "ida-bdf"};
const std::vector<std::string> reference_dampings{"50", "5", "0.5"};
const std::vector<std::string> reference_scenes{"hung-edge", "hung-corners"};

/// What a family computes of a scene, what it counted, and how long it took [s].
struct Solution {
  std::vector<solver::Vectors> positions;
  std::int64_t steps = 0, factorisations = 0;
  double seconds = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Solution, positions, steps, factorisations, seconds)

Solution solve(const std::string& family, const model::Scene& scene) {
  const model::Cloth cloth = model::compile(scene);
  std::vector<double> times;
  for (int k = 1; k <= outputs; ++k) times.push_back(scene.end * k / outputs);
  const auto begin = std::chrono::steady_clock::now();
  const reference::Trajectory trajectory = reference::peer_solver(family).solve(
      cloth.ode, cloth.start, 0, times, {.rtol = reference_rtol, .size = model::size(scene)});
  Solution solution;
  solution.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string prefix = family.substr(0, family.find('-'));
  solution.steps = cloth.ode.work->count(prefix + "/steps");
  solution.factorisations = cloth.ode.work->count(prefix + "/factorisations");
  solution.positions = reference::positions_of(trajectory.states);
  return solution;
}

/// Largest distance of positions at the output times, over the size of the scene.
double largest_distance(const Solution& a, const Solution& b, double size) {
  return reference::largest_rms_distance(a.positions, b.positions) / size;
}

/// What a family has computed of a scene, and how far that is from what CVODE has; it is the first.
struct FamilySolution {
  std::string scene;
  double damping;
  std::string family;
  Solution solution;
  std::optional<double> distance;
};

using results::Cell;
using results::ColumnOf;
using results::field;
using results::Role;
using results::Standing;

results::Verdict agreement(double distance) {
  return distance <= closest ? results::Verdict{Standing::met, "agrees"}
                             : results::Verdict{Standing::missed, "not in agreement"};
}

constexpr ColumnOf<FamilySolution> compared_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&FamilySolution::scene>},
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&FamilySolution::damping>},
    {"family", "family", "", "the solver and its methods", Role::key, field<&FamilySolution::family>},
    {"steps", "steps", "1", "steps of the solver", Role::counter,
     [](const FamilySolution& row) -> Cell { return row.solution.steps; }},
    {"factorisations", "LU", "1", "factorisations of the sparse Newton matrix", Role::counter,
     [](const FamilySolution& row) -> Cell { return row.solution.factorisations; }},
    {"wall", "wall", "s", "wall time, once", Role::time,
     [](const FamilySolution& row) -> Cell { return row.solution.seconds; }},
    {"distance", "from CVODE", "1", "largest distance of positions at ten times, over the size of the scene", Role::error,
     field<&FamilySolution::distance>},
    {"verdict", "verdict", "", "whether it agrees with CVODE to 1e-8", Role::verdict,
     [](const FamilySolution& row) { return row.distance ? Cell(agreement(*row.distance)) : Cell(); }},
};

/// The solutions of all families on a scene.
std::vector<FamilySolution> compared_on(const std::string& name, const std::string& damping, bool quick,
                                        Checkpoint& checkpoint) {
  std::vector<model::Override> overrides{{"material.damping", damping}};
  if (quick) overrides.insert(overrides.end(), {{"grid.n", "6"}, {"end.time", "0.2"}});
  const model::Scene scene = model::load_scene(name, overrides);
  std::vector<FamilySolution> rows;
  for (const std::string& family : family_names) {
    checkpoint.show(fmt::format("{}, d = {}, {}", name, damping, family));
    Solution solution = checkpoint.once(fmt::format("{} {} {}", name, damping, family), [&] { return solve(family, scene); });
    checkpoint.advance();
    std::optional<double> distance;
    if (!rows.empty()) distance = largest_distance(solution, rows.front().solution, model::size(scene));
    rows.push_back({scene.name, scene.sheet.material.damping.weft, family, std::move(solution), distance});
  }
  return rows;
}

std::vector<FamilySolution> compare(bool quick, Checkpoint& checkpoint) {
  std::vector<FamilySolution> rows;
  for (const std::string& name : reference_scenes)
    for (const std::string& damping : reference_dampings)
      std::ranges::move(compared_on(name, damping, quick, checkpoint), std::back_inserter(rows));
  return rows;
}

results::Table compared_table(const std::vector<FamilySolution>& rows) {
  return results::make_table(
      "references", fmt::format("Three families of solvers on the same equation of motion, rtol = {:g}", reference_rtol),
      compared_columns, rows);
}

}  // namespace

std::vector<Job> references(const Question& question) {
  const auto parts = static_cast<int>(reference_scenes.size() * reference_dampings.size() * family_names.size());
  const auto compute = [quick = question.quick](Checkpoint& checkpoint) { return compare(quick, checkpoint); };
  return {job("references", parts, compute, compared_table), growth_of_perturbations(question.quick)};
}

}  // namespace drape::bench
