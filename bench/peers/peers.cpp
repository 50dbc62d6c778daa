#include "bench/peers/peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/peers/springs.hpp"
#include "bench/runs/certified_reference.hpp"
#include "bench/runs/child.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/registry.hpp"
#include "solver/base/temporary.hpp"

namespace drape::bench::peers {
namespace {

namespace fs = std::filesystem;

constexpr Simulator all_simulators[] = {
    {"Bullet", "libbullet-dev", "peer_bullet"},
    {"Bullet, single precision", "libbullet-dev", "peer_bullet_float"},
    {"PETSc", "petsc-dev", "peer_petsc", Forces::ours},
    {.name = "MuJoCo", .package = "@mujoco/mujoco@3.14.0", .program = "mujoco.js", .drags_across = false},
    {.name = "MuJoCo, flex",
     .package = "@mujoco/mujoco@3.14.0",
     .program = "mujoco_flex.js",
     .forces = Forces::membrane,
     .drags_along = false,
     .drags_across = false},
    {.name = "Jolt", .package = "jolt-physics@1.1.0", .program = "jolt.js", .drags_along = false, .drags_across = false},
};
constexpr const Simulator *bullet = &all_simulators[0], *bullet_float = &all_simulators[1], *petsc = &all_simulators[2],
                          *mujoco = &all_simulators[3], *flex = &all_simulators[4], *jolt = &all_simulators[5];

fs::path folder_of_peers() { return DRAPE_PEERS; }

/// The words that run a program, without its argument.
std::vector<std::string> command(const Simulator& simulator) {
  if (!simulator.of_npm()) return {folder_of_peers() / simulator.program};
  return {DRAPE_NODE, fs::path(DRAPE_SOURCE_DIR) / "bench/peers/programs" / simulator.program, folder_of_peers()};
}

/// The number of steps from the start to each compared time; none if the steps do not end there.
std::vector<std::int64_t> steps_to_frames(const std::vector<double>& times, double step) {
  constexpr double part = 1e-6;  ///< of a step
  std::vector<std::int64_t> steps;
  for (const double t : times) {
    const double count = t / step;
    if (count < 0.5 || std::abs(count - std::round(count)) > part * std::max(1.0, count)) return {};
    steps.push_back(std::llround(count));
  }
  return steps;
}

Problem problem_of(const Peer& peer, const model::Scene& scene, double step) {
  if (!scene.sheet.added.empty())
    throw std::invalid_argument(fmt::format("{}: expected a scene without forces.{}: peers have no forces of plugins",
                                            peer.name, scene.sheet.added.front().name));
  Problem problem{.integrator = std::string(peer.integrator), .step = step};
  const std::vector<double> times = compared_times(scene);
  problem.steps = steps_to_frames(times, step);
  if (problem.steps.empty())
    throw std::invalid_argument(fmt::format("{}: expected a step that divides {:g} s, a tenth of the scene's end, not {:g}",
                                            peer.name, times[0], step));
  switch (peer.simulator->forces) {
    case Forces::ours: problem.scene = model::to_toml(model::without_trim(scene)); return problem;
    case Forces::membrane: set_membrane(problem, scene, model::compile(scene)); return problem;
    case Forces::springs: set_springs(problem, scene, model::compile(scene)); break;
  }
  const bool damped = std::ranges::any_of(problem.drag, [](double drag) { return drag != 0; });
  if (damped && !(problem.drag_along ? peer.simulator->drags_along : peer.simulator->drags_across))
    throw std::invalid_argument(fmt::format("{}: {} has no such damping: expected material.damping = 0{}", peer.name,
                                            peer.simulator->name,
                                            peer.simulator->drags_along ? ", or material.damping_form = \"projected\"" : ""));
  return problem;
}

void run_program(const Peer& peer, const fs::path& folder, double limit) {
  std::vector<std::string> words = command(*peer.simulator);
  words.push_back(folder);
  const base::ChildSaid said = run_within<PeerError>(std::move(words), limit);
  if (said.exit_code != 0) throw PeerError(said.failure());
}

/// A frame as a field; a number that is not finite is null in JSON.
solver::Vectors field(const nlohmann::json& frame, double t) {
  solver::Vectors vectors(static_cast<Eigen::Index>(frame.size() / 3), 3);
  for (std::size_t k = 0; k < frame.size(); ++k) {
    if (!frame[k].is_number()) throw PeerError(fmt::format("not finite at {:g} s", t));
    vectors.data()[k] = frame[k].get<double>();
  }
  return vectors;
}

}  // namespace

std::span<const Simulator> simulators() { return all_simulators; }

std::span<const Peer> all_peers() {
  static constexpr Peer table[] = {
      {"bullet-explicit", "Bullet's deformable cloth, explicit: symplectic Euler", bullet, "explicit", 1, true},
      {"bullet-implicit", "the same, implicit with projection: one Newton update a step", bullet, "implicit", 1},
      {"bullet-float-explicit", "bullet-explicit in single precision", bullet_float, "explicit", 1, true},
      {"bullet-float-implicit", "bullet-implicit in single precision", bullet_float, "implicit", 1},
      {"petsc-alpha2", "PETSc TSALPHA2: generalised alpha for second order", petsc, "alpha2", 2},
      {"petsc-rosw", "PETSc TSROSW ra34pw2: Rosenbrock-W method of order 3", petsc, "rosw/ra34pw2", 3},
      {"petsc-bdf2", "PETSc TSBDF of order 2", petsc, "bdf/2", 2},
      {"petsc-arkimex", "PETSc TSARKIMEX 3: additive Runge-Kutta on the split of the thesis", petsc, "arkimex/3", 3},
      {"petsc-verlet", "PETSc TSBASICSYMPLECTIC 2: velocity Verlet", petsc, "basicsymplectic/2", 2, true},
      {"petsc-symplectic4", "PETSc TSBASICSYMPLECTIC 4", petsc, "basicsymplectic/4", 4, true},
      {"mujoco-euler", "MuJoCo, springs as tendons, Euler: symplectic", mujoco, "Euler", 1, true},
      {"mujoco-rk4", "the same by classical Runge-Kutta", mujoco, "RK4", 4, true},
      {"mujoco-implicitfast", "the same, implicit in what depends on velocities: Euler without damping", mujoco, "implicitfast",
       1, true},
      {"mujoco-discrete", "the same, implicit in the forces of tendons as well", mujoco, "discrete", 1},
      {"mujoco-flex-rk4", "MuJoCo's own cloth, a flex of triangles, by classical Runge-Kutta", flex, "RK4", 4, true,
       "mujoco-flex-rk4"},
      {"mujoco-flex-discrete", "the same, implicit in its elastic forces", flex, "discrete", 1, false, "mujoco-flex-rk4"},
      {"jolt-5", "Jolt's soft body in single precision: XPBD, 5 sub-steps a step", jolt, "5", 1},
      {"jolt-20", "the same, 20 sub-steps", jolt, "20", 1},
      {"jolt-100", "the same, 100 sub-steps", jolt, "100", 1},
  };
  return table;
}

const Peer& peer(std::string_view name) { return base::find_named(all_peers(), "peer", name); }

std::string missing(const Simulator& simulator) {
  if (simulator.of_npm()) {
    if (!fs::exists(DRAPE_NODE)) return "node is missing: install the Debian package nodejs and configure again";
    const std::string_view package = simulator.package.substr(0, simulator.package.rfind('@'));
    if (fs::exists(folder_of_peers() / "node_modules" / package)) return "";
    return fmt::format("{} is missing: npm install --prefix {} {}", simulator.name, folder_of_peers().string(),
                       simulator.package);
  }
  if (fs::exists(folder_of_peers() / simulator.program)) return "";
  return fmt::format("{} is missing: install the Debian package {} (apt-get install {}), configure and build again",
                     simulator.name, simulator.package, simulator.package);
}

std::string reason_against(const Peer& peer, const model::Scene& scene, double step) {
  if (std::string what = missing(*peer.simulator); !what.empty()) return what;
  try {
    problem_of(peer, scene, step);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

PeerMotion measuring_motion(const Peer& peer, const model::Scene& scene, double step, double limit) {
  constexpr double longest = 2.5e-4, round_off = 1e-9;                              // [s], of a quotient
  const double parts = std::max(2.0, std::ceil(step / longest * (1 - round_off)));  // 1 would measure a peer by itself
  return run_peer(bench::peers::peer(peer.measured_by), scene, step / parts, limit);
}

PeerMotion run_peer(const Peer& peer, const model::Scene& scene, double step, double limit) {
  if (const std::string what = missing(*peer.simulator); !what.empty()) throw std::invalid_argument(what);
  const base::TemporaryFolder folder;
  std::ofstream(folder / "problem.json") << nlohmann::json(problem_of(peer, scene, step));
  run_program(peer, folder.path(), limit);
  std::ifstream file(folder / "motion.json");
  const nlohmann::json said = nlohmann::json::parse(file);
  PeerMotion motion{said.at("simulator"), said.at("seconds"), compared_times(scene), {}};
  for (std::size_t k = 0; k < motion.times.size(); ++k)
    motion.states.push_back(
        {field(said.at("positions").at(k), motion.times[k]), field(said.at("velocities").at(k), motion.times[k])});
  return motion;
}

}  // namespace drape::bench::peers
