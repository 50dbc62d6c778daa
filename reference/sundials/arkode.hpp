#pragma once

#include "reference/trajectory.hpp"

namespace drape::reference {

/// Solves the split equation of motion with ARKODE's ESDIRK method of order 5 (ARK5(4)8L[2]SA, L-stable) with variable steps:
/// the whole right-hand side implicit, Newton's method with the exact sparse Jacobian factorised by KLU [Kennedy,
/// Carpenter 2003; Reynolds et al. 2023]. Every output time is the end of a step. Arguments and exceptions as for cvode();
/// counts its work under "arkode/".
Trajectory arkode_esdirk(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                         const SolveOptions& options = {});

/// The same with ARKODE's additive (IMEX) pair of order 5 and the split of the thesis [Etzmuß 2002, (3.20)]: dx/dt = v and
/// K x + D v implicit, with the constant Jacobian, f_expl explicit.
Trajectory arkode_imex(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                       const SolveOptions& options = {});

/// The same with ARKODE's explicit Runge-Kutta method of order 2 to 5: no matrices, so for large sheets without damping, whose
/// steps stability bounds but little.
Trajectory arkode_erk(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                      const SolveOptions& options = {});

/// The same with constant steps and the method of options.tuning, which must have both: implicit, explicit or additive.
Trajectory arkode_steps(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                        const SolveOptions& options);

}  // namespace drape::reference
