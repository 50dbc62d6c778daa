#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.hpp"
#include "solver/state.hpp"

namespace drape::bench::peers {

/// What a simulator computes the forces of.
enum class Forces {
  springs,   ///< those of the scene, exactly
  membrane,  ///< a cloth of its own
  ours,      ///< everything: it calls our functions
};

/// A package whose steppers run here, each run in a process of its own: the row of a simulator and its program under
/// bench/peers/programs/ are all there is of it.
struct Simulator {
  std::string_view name;
  std::string_view package;  ///< that has to be installed: of Debian, or of npm with its version
  std::string_view program;  ///< an executable in the build's folder peers, or a script for node
  Forces forces = Forces::springs;
  bool drags_along = true;   ///< whether its springs may have drag along them
  bool drags_across = true;  ///< whether it may be on all relative motion
  bool of_npm() const { return program.ends_with(".js"); }
};

/// A stepper of a simulator, as users name it.
struct Peer {
  std::string_view name;
  std::string_view description;
  const Simulator* simulator;
  std::string_view integrator;  ///< as its program names it
  int order = 1;
  bool is_explicit = false;           ///< so that stability bounds its steps
  std::string_view measured_by = {};  ///< the peer whose motion in short steps its errors are measured by; else the reference
};

/// All of them, whether they are there or not.
std::span<const Simulator> simulators();
std::span<const Peer> all_peers();

/// The peer with this name. Throws std::invalid_argument, naming all that there are.
const Peer& peer(std::string_view name);

/// What is to be installed, in one line, before a simulator runs; empty if it is there.
std::string missing(const Simulator& simulator);

/// The motion of a peer.
struct PeerMotion {
  std::string simulator;              ///< with its version
  double seconds;                     ///< wall time of the steps alone, by the monotonic clock
  std::vector<double> times;          ///< [s]: compared_times()
  std::vector<solver::State> states;  ///< at these times
};

/// A peer that has ended without a motion.
class PeerError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Why a peer cannot run a scene in such steps, in one line; empty if it can.
std::string reason_against(const Peer& peer, const model::Scene& scene, double step);

/// The motion that the errors of a peer with a cloth of its own are measured by, in steps of half of `step` [s], that of the
/// run, or shorter. Exceptions as for run_peer().
PeerMotion measuring_motion(const Peer& peer, const model::Scene& scene, double step, double limit);

/// Runs a peer on a scene in steps [s]. Throws std::invalid_argument with reason_against(), and PeerError if it fails, if
/// something is not finite, or if it takes longer than `limit` [s] in all.
PeerMotion run_peer(const Peer& peer, const model::Scene& scene, double step, double limit);

}  // namespace drape::bench::peers
