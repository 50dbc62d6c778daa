#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "bench/score/external_motion.hpp"
#include "bench/score/observables.hpp"

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
  Uncertain left;     ///< root mean square distance over frames and particles from the reference earlier by the lag [m]
};

std::vector<FrameScore> frame_scores(const ExternalMotion& external, const TrueMotion& truth);

/// The delay of the frames, as delay() has it. A lag at either bound may be more. The uncertainty is that of positions over the
/// mean velocity. NaN if nothing moves.
Lag lag(const ExternalMotion& external, const TrueMotion& truth);

/// How much faster than the reference's the kinetic energy of a motion falls: the rate δ [1/s] for which (1 − δ t) K_ref(t − τ)
/// comes nearest to K(t), in the sum of squares over all frames. The lag τ is taken out first: what is late is not damped.
/// Where velocities are differences of frames, the reference's are as well. Below zero: the motion is too lively. The
/// uncertainty is the δ of the reference's other family. NaN if nothing moves.
Uncertain damping(const ExternalMotion& external, const TrueMotion& truth, const Lag& late);

}  // namespace drape::bench
