#pragma once

#include "solver/step.hpp"

namespace drape::solver {

/// The largest stable sub-step of a method at a state [s].
using SubStepLimit = double (*)(const SplitOde& ode, double t, const State& y);

/// Divides the step into equal sub-steps inside the limit. `whole_step` computes y1 from y0 in this number of them, and returns
/// false as soon as `limit_narrowed`: then the step is repeated.
void sub_step(Step& s, SubStepLimit limit, bool (*whole_step)(Step& s, double substeps));

/// After a sub-step that has led to time t, the positions of y1 and the velocities v: whether the limit is narrower by now than
/// the one that is used. It is estimated only if something has stretched, or if `alarmed`.
bool limit_narrowed(Step& s, SubStepLimit limit, double t, const Vectors& v, bool alarmed);

/// An alarm for methods whose fastest modes alternate at the limit: whether the forces f after each sub-step alternate and
/// grow. weight: 1/m, 0 for pinned coordinates.
inline bool alternates(Step& s, const Vectors& f, const Vectors& weight) {
  return s.sub_stepping.limit_watch.alarmed(f, weight, *s.ode.partition);
}

/// 1/m of all coordinates, 0 of those that are pinned. What oblique pins hold has to be filtered as well.
void inverse_masses(const SplitOde& ode, Vectors& w);

}  // namespace drape::solver
