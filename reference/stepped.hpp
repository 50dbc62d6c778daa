#pragma once

#include "reference/trajectory.hpp"
#include "solver/methods.hpp"

namespace drape::reference {

/// One of our own methods with steps that divide the times between outputs and are at most `step` [s], its systems solved to
/// round-off of what matters. Throws ReferenceError if a step fails.
Trajectory stepped(const solver::SplitOde& ode, const solver::Method& method, const solver::State& y0, double t0,
                   std::span<const double> times, double step);

}  // namespace drape::reference
