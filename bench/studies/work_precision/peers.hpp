#pragma once

#include "bench/studies/work_precision/configurations.hpp"
#include "reference/newton_solves.hpp"
#include "reference/tableaux.hpp"

namespace drape::bench {

/// One way to set SUNDIALS up. It solves the same forces as our methods do, and where it factors, with our factor.
struct PeerSetup {
  Code package;                                    ///< a peer solver, or arkode_steps with a tableau
  const reference::NewtonSolve* newton = nullptr;  ///< null if it solves no systems
  int order = 5;
  double velocity_weight = 1;  ///< as reference::Tuning has it, as the following
  double kept_factor = 1e-12;
  double nonlinear = 0;
  const reference::Tableau* tableau = nullptr;
  double stage_tolerance = 0;  ///< of nonlinear systems with constant steps
  bool deduced = false;

  std::string name() const;
};

/// What the authors of CVODE advise for large stiff systems where a preconditioner is known: BDF of all orders, GMRES, and the
/// absolute tolerances of the scene's own scales.
std::string advised_peer();

/// States at some times; `value`: step [s] or tolerance. Constant steps end at all of these times. Exceptions as for the peer
/// solver.
std::vector<solver::State> solve_by_peer(const PeerSetup& setup, double value, double size, const solver::SplitOde& ode,
                                         const solver::State& start, std::span<const double> times);

/// All setups that are tried: as many as of ours.
std::vector<PeerSetup> peer_setups(Search search);

Configuration peer_configuration(const PeerSetup& setup, const model::Scene& scene, Search search);

void add_peers(std::vector<Configuration>& all, const model::Scene& scene, Search search);

}  // namespace drape::bench
