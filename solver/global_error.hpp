#pragma once

#include <string>

#include "solver/integrator.hpp"

namespace drape::solver {

/// How a run is controlled so that its global error comes near its tolerance.
struct GlobalControl {
  double tolerance = 0;     ///< of the local error
  double largest_step = 0;  ///< [s]
  bool feasible = true;     ///< whether it takes no more steps than the options allow
  std::string remark;       ///< why not, or what limits its steps but the tolerance; else empty
};

/// Control of the local error leaves open how errors add up: the global one goes with a power p/(p + 1) of the tolerance, times
/// the conditioning of the scene and whatever an estimate misjudges. So they are measured: pilot runs from the integrator's
/// state to t_end, each up to ten times as accurate as the one before, go on until their distances fall as they should and are
/// near the tolerance; trials between them or just beyond follow until one comes near it. The run repeats that pilot   [Cao,
/// Petzold 2004, who measure by adjoints].
///
/// The error is the largest at all tenths of the run, in the root mean square of positions over the length. h: the largest step
/// [s]. The pilots' steps are counted as "pilot_steps" instead of "steps"; their other work is work of the run.
GlobalControl plan_global_control(const Integrator& integrator, double t_end, double h);

}  // namespace drape::solver
