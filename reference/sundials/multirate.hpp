#pragma once

#include "reference/trajectory.hpp"

namespace drape::reference {

/// Solves the split equation of motion with ARKODE's multirate method MRI-GARK-ERK45a, of order 4, explicit: dx/dt = v and K x
/// + D v are fast and followed by an explicit Runge-Kutta method with steps of its own, f_expl is slow [Sandu 2019; Reynolds et
/// al. 2023]. Every output time is the end of a slow step. Arguments and exceptions as for cvode().
///
/// Slow steps are constant: of options.tuning.step; or, without one, halved until the states at the output times change by
/// less than rtol in the norm of SolveOptions. Counts its work under "multirate/".
Trajectory arkode_multirate(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                            const SolveOptions& options = {});

}  // namespace drape::reference
