#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace drape::bench::peers {

/// What a program that runs a peer reads from problem.json.
struct Problem {
  std::string integrator;                ///< as the program names it
  double step = 0;                       ///< [s]
  std::vector<std::int64_t> steps = {};  ///< from the start to each frame that is asked for, ascending

  std::string scene = {};  ///< TOML, for a program that has our forces; all that follows is then empty

  std::vector<double> mass = {};        ///< N [kg]
  std::vector<double> positions = {};   ///< 3N, particle by particle [m]
  std::vector<double> velocities = {};  ///< the same [m/s]
  std::vector<int> pinned = {};         ///< particles that stay where they are
  std::array<double, 3> gravity = {};   ///< [m/s²]

  std::vector<std::array<int, 2>> ends = {};  ///< of springs
  std::vector<double> rest = {};              ///< their lengths [m]
  std::vector<double> stiffness = {};         ///< [N/m]
  std::vector<double> drag = {};              ///< [N s/m]
  bool drag_along = true;                     ///< whether drag is along springs only, and not of all relative motion

  std::vector<std::array<int, 3>> triangles = {};  ///< of a membrane, in the place of springs
  double young = 0;                                ///< its modulus times its thickness [N/m]; Poisson's ratio is 0
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Problem, integrator, step, steps, scene, mass, positions, velocities, pinned, gravity, ends,
                                   rest, stiffness, drag, drag_along, triangles, young)

/// What it writes to motion.json.
struct Solved {
  std::string simulator;                             ///< with its version
  double seconds = 0;                                ///< wall time of the steps alone, by the monotonic clock
  std::vector<std::vector<double>> positions = {};   ///< a frame each, 3N [m]
  std::vector<std::vector<double>> velocities = {};  ///< the same [m/s]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Solved, simulator, seconds, positions, velocities)

}  // namespace drape::bench::peers
