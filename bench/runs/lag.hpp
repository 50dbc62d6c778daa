#pragma once

#include <limits>
#include <span>
#include <vector>

#include "reference/trajectory.hpp"

namespace drape::bench {

/// Times this close, over the end, are one.
inline constexpr double same_time = 1e-9;

/// The state of a motion at a time: between its times by cubic Hermite interpolation, before the start as at the start, but at
/// rest. The first state is the start, at t = 0.
solver::State state_at(const reference::Trajectory& motion, double t);

/// Error of positions between the times, root mean square over time and particles [m], estimated by what leaving out every
/// other time would change: the interpolation is of fourth order.
double interpolation_error(const reference::Trajectory& motion);

/// The part of a motion that another may be late by.
inline constexpr double longest_lag = 0.25;

/// How late some states are, and how wrong if that is forgiven.
struct Delay {
  double seconds = std::numeric_limits<double>::quiet_NaN();  ///< negative: they are ahead; NaN if nothing moves
  double left = 0;                                            ///< root mean square distance from the motion later by that [m]
  double speed = std::numeric_limits<double>::quiet_NaN();    ///< of the motion there, root mean square [m/s]
};

/// The delay τ that minimises the mean over states and particles of |x(t) − x_ref(t − τ)|²: the best of a scan up to a quarter
/// of the time either way, improved by Gauss-Newton steps. Before the start the motion rests at its start; states for which it
/// would have to go on beyond its end are left out. `times` [s] ascend.
Delay delay(std::span<const double> times, std::span<const solver::State> states, const reference::Trajectory& motion);

}  // namespace drape::bench
