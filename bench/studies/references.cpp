#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "bench/runs/certified_reference.hpp"
#include "bench/studies/studies.hpp"
#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "reference/growth.hpp"
#include "reference/reference.hpp"
#include "reference/sundials/cvode.hpp"
#include "reference/sundials/peer_solvers.hpp"
#include "results/columns.hpp"
#include "results/verdict.hpp"

namespace drape::bench {
namespace {

constexpr double bar = 2;       ///< largest factor by which the growth may be underestimated
constexpr double rtol = 1e-12;  // differences of 1e-7 are taken
constexpr int rounds[] = {0, 1, 2, 6};

struct GrowthScene {
  const char *scene, *damping;
  double end;                    ///< [s]
  const char* pleats = nullptr;  ///< of its start, if not those of its file
};
constexpr std::array<GrowthScene, 4> growing{
    {{"hung-corners", "0", 0.3}, {"hung-corners", "0.05", 0.4}, {"hung-corners", "5", 0.3}, {"wind", "5", 0.3, "[1, 35]"}}};

/// Growth of the perturbation that each number of rounds finds, and the largest of all.
struct Growths {
  std::vector<double> found;
  double largest = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Growths, found, largest)

Growths grow(const model::Scene& scene) {
  const model::Cloth cloth = model::compile(scene);
  const double size = model::size(scene);
  const std::vector<double> times{scene.end};
  const auto solve = [&](const solver::State& start) {
    return reference::cvode(cloth.ode, start, 0, times, {.rtol = rtol, .size = size});
  };
  const reference::Trajectory motion = solve(cloth.start);
  Growths growths;
  for (const int count : rounds) {
    const solver::State direction = reference::fastest_growing(cloth.ode, cloth.start, 0, times, size, count);
    growths.found.push_back(reference::growth_along(direction, cloth.start, motion, size, solve).factors.back());
  }
  growths.largest = reference::largest_growth(cloth.ode, cloth.start, 0, motion, size, solve);
  return growths;
}

/// A sheet with its growths.
struct Grown {
  model::Scene scene;
  Growths growths;

  double factor() const { return growths.largest / growths.found.back(); }
};

using results::ColumnOf;
using results::Datum;
using results::field;
using results::Role;
using results::Standing;

constexpr ColumnOf<Grown> sheet_columns[] = {
    {"scene", "scene", "", "its name", Role::key, [](const Grown& row) -> Datum { return row.scene.name; }},
    {"n", "n", "1", "particles a side", Role::key, [](const Grown& row) { return results::to_datum(row.scene.sheet.grid.nu); }},
    {"damping", "d", "N s/m", "linear damping", Role::key,
     [](const Grown& row) -> Datum { return row.scene.sheet.material.damping.weft; }},
    {"end", "end", "s", "when it is measured", Role::key, [](const Grown& row) -> Datum { return row.scene.end; }},
    {"largest", "largest", "1", "largest singular value of the motion, by differences", Role::quantity,
     [](const Grown& row) -> Datum { return row.growths.largest; }},
};

constexpr ColumnOf<double> round_columns[] = {
    {"rounds_{}", "{} rounds", "1", "growth of the perturbation found in this number of rounds", Role::quantity,
     [](const double& growth) -> Datum { return growth; }},
};

results::Verdict judge(double factor) { return results::check(factor <= bar, "as wanted", "not as wanted"); }

constexpr ColumnOf<Grown> factor_columns[] = {
    {"factor", "factor", "1", "the largest over the last", Role::quantity,
     [](const Grown& row) -> Datum { return row.factor(); }},
    {"verdict", "verdict", "", "whether the factor is at most 2", Role::verdict,
     [](const Grown& row) -> Datum { return judge(row.factor()); }},
};

results::Table to_table(const std::vector<Grown>& rows) {
  results::Table table =
      results::make_table("growth",
                          "Growth of a small perturbation of the start: of the one that grows most, as rounds "
                          "of the power method find it, and of any",
                          sheet_columns, rows);
  for (std::size_t k = 0; k < std::size(rounds); ++k) {
    const std::string count = std::to_string(rounds[k]);
    results::add_columns(table, round_columns, rows, [k](const Grown& row) { return &row.growths.found[k]; },
                         {count, count, {}});
  }
  results::add_columns(table, factor_columns, rows);
  return table;
}

std::vector<Grown> grown(bool quick, Checkpoint& checkpoint) {
  std::vector<Grown> rows;
  checkpoint.each(growing, [&](const GrowthScene& sheet) {
    std::vector<model::Override> overrides{{"grid.n", quick ? "4" : "6"}, {"material.damping", sheet.damping}};
    if (sheet.pleats != nullptr) overrides.push_back({"start.pleats", sheet.pleats});
    model::Scene scene = model::load_scene(sheet.scene, overrides);
    scene.end = quick ? sheet.end / 2 : sheet.end;
    const std::string name = fmt::format("growth on {}, d = {}", sheet.scene, sheet.damping);
    checkpoint.show(name);
    rows.push_back({scene, checkpoint.once(name, [&] { return grow(scene); })});
    checkpoint.advance();
  });
  return rows;
}

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

results::Verdict agreement(double distance) { return results::check(distance <= closest, "agrees", "not in agreement"); }

constexpr ColumnOf<PeerSolution> compared_columns[] = {
    {"scene", "scene", "", "its name", Role::key, field<&PeerSolution::scene>},
    {"damping", "d", "N s/m", "linear damping", Role::key, field<&PeerSolution::damping>},
    {"family", "family", "", "the solver and its methods", Role::key, field<&PeerSolution::peer>},
    {"steps", "steps", "1", "steps of the solver", Role::counter,
     [](const PeerSolution& row) -> Datum { return row.solution.steps; }},
    {"factorisations", "LU", "1", "factorisations of the sparse Newton matrix", Role::counter,
     [](const PeerSolution& row) -> Datum { return row.solution.factorisations; }},
    {"wall", "wall", "s", "wall time, once", Role::time, [](const PeerSolution& row) -> Datum { return row.solution.seconds; }},
    {"distance", "from CVODE", "1", "largest distance of positions at ten times, over the size of the scene", Role::error,
     field<&PeerSolution::distance>},
    {"verdict", "verdict", "", "whether it agrees with CVODE to 1e-8", Role::verdict,
     [](const PeerSolution& row) { return row.distance ? Datum(agreement(*row.distance)) : Datum(); }},
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
        checkpoint.timed(fmt::format("{} {} {}", name, damping, peer.solver), [&] { return solve(peer, scene); });
    checkpoint.advance();
    std::optional<double> distance;
    if (!rows.empty()) distance = largest_distance(solution, rows.front().solution, model::size(scene));
    rows.push_back({scene.name, scene.sheet.material.damping.weft, peer.solver, std::move(solution), distance});
  }
  return rows;
}

std::vector<PeerSolution> compare(bool quick, Checkpoint& checkpoint) {
  std::vector<PeerSolution> rows;
  checkpoint.each(reference_scenes, [&](const std::string& name) {
    checkpoint.each(reference_dampings, [&](const std::string& damping) {
      std::ranges::move(compared_on(name, damping, quick, checkpoint), std::back_inserter(rows));
    });
  });
  return rows;
}

results::Table compared_table(const std::vector<PeerSolution>& rows) {
  return results::make_table(
      "references", fmt::format("Three families of solvers on the same equation of motion, rtol = {:g}", reference_rtol),
      compared_columns, rows);
}

/// How much perturbations of small sheets grow: the one that is found to grow most against the largest singular value.
Job growth_of_perturbations(bool quick) {
  return job(
      "growth", static_cast<int>(growing.size()), [quick](Checkpoint& checkpoint) { return grown(quick, checkpoint); },
      to_table);
}

}  // namespace

std::vector<Job> references(const Question& question) {
  const auto parts = static_cast<int>(reference_scenes.size() * reference_dampings.size() * compared_peers.size());
  const auto compute = [quick = question.quick](Checkpoint& checkpoint) { return compare(quick, checkpoint); };
  return {job("references", parts, compute, compared_table), growth_of_perturbations(question.quick)};
}

}  // namespace drape::bench
