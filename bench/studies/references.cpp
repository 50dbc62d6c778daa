#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>

#include "bench/runs/certified_reference.hpp"
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

/// A peer solver, and what the names of its counters begin with.
struct Peer {
  std::string solver, package;
};
const std::vector<Peer> compared_peers{{"cvode-bdf", "cvode"}, {"arkode-esdirk", "arkode"}, {"ida-bdf", "ida"}};
const std::vector<std::string> reference_dampings{"50", "5", "0.5"};
const std::vector<std::string> reference_scenes{"hung-edge", "hung-corners"};

/// What a peer solver computes of a scene, what it counted, and how long it took [s].
struct Solution {
  std::vector<solver::Vectors> positions;
  std::int64_t steps = 0, factorisations = 0;
  double seconds = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Solution, positions, steps, factorisations, seconds)

Solution solve(const Peer& peer, const model::Scene& scene) {
  const model::Cloth cloth = model::compile(scene);
  const auto begin = std::chrono::steady_clock::now();
  const reference::Trajectory trajectory =
      reference::peer_solver(peer.solver)
          .solve(cloth.ode, cloth.start, 0, compared_times(scene), {.rtol = reference_rtol, .size = model::size(scene)});
  Solution solution;
  solution.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  solution.steps = cloth.ode.work->count(peer.package + "/steps");
  solution.factorisations = cloth.ode.work->count(peer.package + "/factorisations");
  solution.positions = reference::positions_of(trajectory.states);
  return solution;
}

/// Largest distance of positions at the output times, over the size of the scene.
double largest_distance(const Solution& a, const Solution& b, double size) {
  return reference::largest_rms_distance(a.positions, b.positions) / size;
}

/// What a peer solver has computed of a scene, and how far that is from what CVODE has; it is the first.
struct PeerSolution {
  std::string scene;
  double damping;
  std::string peer;
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

constexpr ColumnOf<PeerSolution> compared_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&PeerSolution::scene>},
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&PeerSolution::damping>},
    {"family", "family", "", "the solver and its methods", Role::key, field<&PeerSolution::peer>},
    {"steps", "steps", "1", "steps of the solver", Role::counter,
     [](const PeerSolution& row) -> Cell { return row.solution.steps; }},
    {"factorisations", "LU", "1", "factorisations of the sparse Newton matrix", Role::counter,
     [](const PeerSolution& row) -> Cell { return row.solution.factorisations; }},
    {"wall", "wall", "s", "wall time, once", Role::time, [](const PeerSolution& row) -> Cell { return row.solution.seconds; }},
    {"distance", "from CVODE", "1", "largest distance of positions at ten times, over the size of the scene", Role::error,
     field<&PeerSolution::distance>},
    {"verdict", "verdict", "", "whether it agrees with CVODE to 1e-8", Role::verdict,
     [](const PeerSolution& row) { return row.distance ? Cell(agreement(*row.distance)) : Cell(); }},
};

/// The solutions of all peer solvers on a scene.
std::vector<PeerSolution> compared_on(const std::string& name, const std::string& damping, bool quick, Checkpoint& checkpoint) {
  std::vector<model::Override> overrides{{"material.damping", damping}};
  if (quick) overrides.insert(overrides.end(), {{"grid.n", "6"}, {"end.time", "0.2"}});
  const model::Scene scene = model::load_scene(name, overrides);
  std::vector<PeerSolution> rows;
  for (const Peer& peer : compared_peers) {
    checkpoint.show(fmt::format("{}, d = {}, {}", name, damping, peer.solver));
    Solution solution =
        checkpoint.once(fmt::format("{} {} {}", name, damping, peer.solver), [&] { return solve(peer, scene); });
    checkpoint.advance();
    std::optional<double> distance;
    if (!rows.empty()) distance = largest_distance(solution, rows.front().solution, model::size(scene));
    rows.push_back({scene.name, scene.sheet.material.damping.weft, peer.solver, std::move(solution), distance});
  }
  return rows;
}

std::vector<PeerSolution> compare(bool quick, Checkpoint& checkpoint) {
  std::vector<PeerSolution> rows;
  for (const std::string& name : reference_scenes)
    for (const std::string& damping : reference_dampings)
      std::ranges::move(compared_on(name, damping, quick, checkpoint), std::back_inserter(rows));
  return rows;
}

results::Table compared_table(const std::vector<PeerSolution>& rows) {
  return results::make_table(
      "references", fmt::format("Three families of solvers on the same equation of motion, rtol = {:g}", reference_rtol),
      compared_columns, rows);
}

}  // namespace

std::vector<Job> references(const Question& question) {
  const auto parts = static_cast<int>(reference_scenes.size() * reference_dampings.size() * compared_peers.size());
  const auto compute = [quick = question.quick](Checkpoint& checkpoint) { return compare(quick, checkpoint); };
  return {job("references", parts, compute, compared_table), growth_of_perturbations(question.quick)};
}

}  // namespace drape::bench
