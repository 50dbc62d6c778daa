#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bench/foreign/foreign_motion.hpp"
#include "bench/foreign/observables.hpp"

namespace drape::bench {

/// A number with what it is uncertain by.
struct Uncertain {
  double value = std::numeric_limits<double>::quiet_NaN();
  double uncertainty = std::numeric_limits<double>::quiet_NaN();
};

/// A frame against the reference at its time.
struct FrameScore {
  double t;                                                 ///< [s]
  double rms;                                               ///< root mean square over the particles of the distance [m]
  double maximum;                                           ///< largest distance [m]
  double uncertainty;                                       ///< of the reference, as rms [m]
  double centre;                                            ///< distance of the centres of mass [m]
  Observables own;                                          ///< of the frame
  UncertainObservables truth;                               ///< of the reference; velocities by differences if the frame's are
  double depth = std::numeric_limits<double>::quiet_NaN();  ///< greatest depth in an obstacle [m]; NaN without
  double true_depth = std::numeric_limits<double>::quiet_NaN();  ///< the same of the reference
};

/// How late a motion is, and how wrong if that is forgiven.
struct Lag {
  Uncertain seconds;  ///< negative: it is ahead
  Uncertain left;     ///< root mean square distance over frames and particles from the reference so much earlier [m]
};

std::vector<FrameScore> frame_scores(const ForeignMotion& foreign, const TrueMotion& truth);

/// The delay τ that minimises the mean over frames and particles of |x(t) − x_ref(t − τ)|²: the best of a scan up to a quarter
/// of the motion either way, improved by Gauss-Newton steps. Before the start the reference rests at its start; frames for
/// which it would have to go on beyond its end are left out. The uncertainty is that of positions over the mean velocity. NaN
/// if nothing moves.
Lag lag(const ForeignMotion& foreign, const TrueMotion& truth);

/// How much faster a motion loses energy than the reference, as a rate δ [1/s]: an additional force −δ m v on each particle
/// takes δ ∫ 2 E_kin dt. So δ is the least-squares slope through the origin, over all frames, of E_ref(t) − E(t) against
/// ∫ 2 E_kin,ref dt. The amplitude of a free oscillation then decays by exp(−δ t/2) more than it should; below zero, the motion
/// gains energy. Its uncertainty is the δ of the reference's other family. NaN if nothing moves.
Uncertain damping(const std::vector<FrameScore>& frames, const ForeignMotion& foreign, const TrueMotion& truth);

}  // namespace drape::bench
