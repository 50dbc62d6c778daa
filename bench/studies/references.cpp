#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bench/studies/references_growth.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "results/table_builder.hpp"

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

void add_row(results::TableBuilder& table, const model::Scene& scene, const std::string& family, const Solution& solution,
             const Solution& first) {
  table.row();
  table.text("scene", "scene", "its name", scene.name);
  table.number("damping", "d", "N s/m", "linear damping", scene.sheet.material.damping.weft);
  table.text("family", "family", "the solver and its methods", family);
  table.count("steps", "steps", "steps of the solver", solution.steps);
  table.count("factorisations", "LU", "factorisations of the sparse Newton matrix", solution.factorisations);
  table.number("wall", "wall", "s", "wall time, once", solution.seconds);
  if (&solution == &first) return;
  const double apart = largest_distance(solution, first, model::size(scene));
  table.number("distance", "from CVODE", "1", "largest distance of positions at ten times, over the size of the scene", apart);
  table.text("verdict", "verdict", "whether it agrees with CVODE to 1e-8", apart <= closest ? "agrees" : "NOT in agreement");
}

results::Table compare(bool quick, Checkpoint& checkpoint) {
  results::TableBuilder table(
      "references", fmt::format("Three families of solvers on the same equation of motion, rtol = {:g}", reference_rtol));
  for (const std::string& name : reference_scenes)
    for (const std::string& damping : reference_dampings) {
      std::vector<model::Override> overrides{{"material.damping", damping}};
      if (quick) overrides.insert(overrides.end(), {{"grid.n", "6"}, {"end.time", "0.2"}});
      const model::Scene scene = model::load_scene(name, overrides);
      std::vector<Solution> solutions;
      for (const std::string& family : family_names) {
        checkpoint.show(fmt::format("{}, d = {}, {}", name, damping, family));
        solutions.push_back(
            checkpoint.once(fmt::format("{} {} {}", name, damping, family), [&] { return solve(family, scene); }));
        checkpoint.advance();
      }
      for (std::size_t k = 0; k < family_names.size(); ++k)
        add_row(table, scene, family_names[k], solutions[k], solutions.front());
    }
  return table.finish();
}

}  // namespace

std::vector<TableJob> references(bool quick) {
  const auto parts = static_cast<int>(reference_scenes.size() * reference_dampings.size() * family_names.size());
  return {{parts, [quick](Checkpoint& checkpoint) { return compare(quick, checkpoint); }},
          {growth_parts, [quick](Checkpoint& checkpoint) { return growth_of_perturbations(quick, checkpoint); }}};
}

}  // namespace drape::bench
