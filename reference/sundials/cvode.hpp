#pragma once

#include "reference/trajectory.hpp"

namespace drape::reference {

/// Solves the split equation of motion with CVODE: BDF of orders 1 to 5 with variable step and stability limit detection,
/// Newton's method with the exact sparse Jacobian factorised by KLU [Hindmarsh et al. 2005, SUNDIALS].
///
/// Output times [s] increase, none is before t0 and the last is after it; output between steps is interpolated with the
/// method's own polynomial. Nothing is evaluated after the last time. The velocities of pinned coordinates in y0 are ignored.
/// Counts its work in ode.work under "cvode/". Throws ReferenceError if the solution cannot be followed, and
/// std::invalid_argument if it is ill posed.
Trajectory cvode(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                 const SolveOptions& options = {});

/// The same with the Adams-Moulton formulas of orders 1 to 12 (max_order of them) and functional iteration: no matrices, for
/// problems that are not stiff.
Trajectory cvode_adams(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                       const SolveOptions& options = {});

}  // namespace drape::reference
