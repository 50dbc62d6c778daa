#pragma once

#include "reference/cvode.hpp"

namespace drape::reference {

/// A trajectory to measure others by, with its own uncertainty.
struct Reference {
  std::string name;           ///< of the solver, for example "cvode-bdf"
  double tolerance = 0;       ///< relative tolerance of the trajectory
  std::vector<double> error;  ///< [m], uncertainty of the positions at each time, in the measure of rms_distance
  Trajectory trajectory;
};

/// Root mean square over the particles of the distance [m] between two sets of positions.
double rms_distance(const solver::Vectors& a, const solver::Vectors& b);

/// Solves with CVODE at the given rtol, and once more at 100 rtol: the distance between the two is the uncertainty. It is in
/// effect the error of the looser solution. Over all times it overestimated the largest error of the one returned by factors of
/// 10 to 300 on motions known exactly; at a single time the two may meet by chance, so prefer its maximum over several times.
/// Arguments and exceptions as for cvode().
Reference reference(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                    const CvodeOptions& options = {});

}  // namespace drape::reference
