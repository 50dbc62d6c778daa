#pragma once

#include "reference/trajectory.hpp"

namespace drape::reference {

/// Where all forces on the free coordinates cancel.
struct Equilibrium {
  solver::Vectors x;    ///< N × 3 [m]
  double residual = 0;  ///< largest component of the force that is left [N]
  int iterations = 0;
};

/// When an equilibrium is found: the largest component of the force is at most `force` [N] or what rounding makes of it, or a
/// Newton step moves nothing by more than `step` [m].
struct EquilibriumOptions {
  double force = 1e-12;
  double step = 1e-13;
  int max_iterations = 200;
  bool line_search =
      true;  ///< on the sum of squares of the forces; near the solution plain Newton steps do better on stiff sheets
};

/// Solves f(t, x, 0) = 0 for the free coordinates with KINSOL: Newton's method with line search and the exact sparse Jacobian
/// factorised by KLU [Hindmarsh et al. 2005, SUNDIALS]. Pinned coordinates stay where `guess` (N × 3) has them. Finds the
/// equilibrium near the guess, stable or not; the Jacobian must not be singular on the way. Counts its work in ode.work under
/// "kinsol/". Throws ReferenceError if there is none to be found.
Equilibrium equilibrium(const solver::SplitOde& ode, const solver::Vectors& guess, const EquilibriumOptions& options = {});

}  // namespace drape::reference
