#pragma once

#include <string>

#include "solver/integrator.hpp"

namespace drape::solver {

/// How the steps of a run are controlled so that its global error is near its tolerance.
struct GlobalControl {
  double tolerance = 0;     ///< of the local error
  double largest_step = 0;  ///< [s]
  bool feasible = true;     ///< whether it takes no more steps than the options allow
  std::string remark;       ///< why not, or what limits its steps except the tolerance; empty otherwise
};

/// Control of the local error does not bound the global one, which goes with a power p/(p + 1) of the tolerance, times the
/// conditioning of the scene and the errors of the estimate. So it is measured: pilot runs from the integrator's state to
/// t_end, each up to ten times as accurate as the one before, continue until their distances fall as expected and are near the
/// tolerance; trials between them or just beyond follow until one comes near it. The run repeats that pilot   [Cao, Petzold
/// 2004, with adjoints].
///
/// The error is the root mean square of positions over the length, the largest at all tenths of the run. h: the largest step
/// [s]. The pilots' steps are counted as "pilot_steps" instead of "steps"; their other work is work of the run.
GlobalControl plan_global_control(const Integrator& integrator, double t_end, double h);

}  // namespace drape::solver
