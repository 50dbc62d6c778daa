#pragma once

#include <string_view>

#include "reference/trajectory.hpp"

namespace drape::reference {

/// A general solver that follows the same equation of motion by a family of methods of its own.
struct PeerSolver {
  std::string_view name;
  std::string_view description;
  Trajectory (*solve)(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                      const SolveOptions& options);
  bool implicit = true;  ///< solves linear systems
};

/// All families: linear multistep methods, Runge-Kutta methods, and the residual form.
std::span<const PeerSolver> peer_solvers();

/// The family with this name. Throws std::invalid_argument, naming all that there are.
const PeerSolver& peer_solver(std::string_view name);

/// Solves with an implicit family, its Newton systems by our factor of the constant matrix, the quickest where GMRES gets by
/// with it; where it does not, by KLU, which is slow and needs no luck, counted as "reference/klu_fallbacks". The Newton solve
/// of `options` has no meaning here. Exceptions as for cvode().
Trajectory solve_by_either(const PeerSolver& solver, const solver::SplitOde& ode, const solver::State& y0, double t0,
                           std::span<const double> times, SolveOptions options);

}  // namespace drape::reference
