#pragma once

#include "bench/studies/work_precision/candidates.hpp"
#include "reference/sundials/peer_solvers.hpp"

namespace drape::bench {

/// One way to set SUNDIALS up. It solves the same forces as our methods do, and where it factors, with our factor.
struct PeerSetup {
  /// A family of reference/sundials/peer_solvers.hpp, or "arkode-steps" with a method of reference/tableaux.hpp.
  std::string package;
  std::string newton;  ///< one of reference/newton_solves.hpp; empty if it solves no systems
  int order = 5;
  double velocity_weight = 1;  ///< as reference::Tuning has it, as the following
  double kept_factor = 1e-12;
  double nonlinear = 0;
  std::string tableau = {};
  double stage_tolerance = 0;  ///< of nonlinear systems with constant steps
  bool deduced = false;

  /// Whose it is, for contenders: the package.
  std::string name() const;
};

/// What the authors of CVODE advise for large stiff systems where a preconditioner is known: BDF of all orders, GMRES, and the
/// absolute tolerances of the scene's own scales.
std::string advised_peer();

/// States at some times; `value`: step [s] or tolerance. Constant steps end at all of these times.
std::vector<solver::State> solve_by_peer(const PeerSetup& setup, double value, double size, const model::Cloth& cloth,
                                         std::span<const double> times);

/// All setups that are tried: as many as of ours.
std::vector<PeerSetup> peer_setups(Search search);

Family peer_family(const PeerSetup& setup, const model::Scene& scene, Search search);

void add_peers(std::vector<Family>& all, const model::Scene& scene, Search search);

}  // namespace drape::bench
