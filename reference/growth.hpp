#pragma once

#include <functional>

#include "reference/trajectory.hpp"

namespace drape::reference {

/// How a small perturbation of the start grows.
struct Growth {
  std::vector<double> factors;  ///< at each time: of its positions (rms), over its size at the start
  Trajectory perturbed;         ///< from the perturbed start
};

/// Size [m] of a perturbation: √(|x|² + |duration v|²), root mean squares over the particles.
double perturbation_size(const solver::State& change, double duration);

/// A perturbation of the start of size 1 that grows most until the times [s] after t0, as nearly as the power method finds it
/// from normal noise: each round applies PᵀP, where P is the linearised motion about y0's own, from (x, duration v) to the
/// positions at all these times together, and in the last rounds at the one where they are largest. It ends where a round gains
/// less than a tenth, after `rounds` at most. The linearised motion has 30 steps, or twice as many until half of a step
/// predicts the same growth within a factor of 1.5. It takes two of CVODE's trajectories at rtol = 1e-5, and another for every
/// doubling.
///
/// If the noise has the part c in the direction that grows most, r rounds, if none ends it earlier, find one that grows by at
/// least c^(1/(2r + 1)) of the largest singular value of P. Of a random direction in n dimensions c < δ/√n has a probability of
/// 0.8 δ. So 6 rounds find at least half of it with a probability of 0.99 for n = 2400, whatever the other singular values are.
/// Exceptions as for cvode().
solver::State fastest_growing(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                              double size, int rounds = 6, unsigned seed = 1);

/// Solves from another start, at the times of a trajectory.
using SolveFrom = std::function<Trajectory(const solver::State& start)>;

/// The largest growth that any perturbation of the start has at the end of `unperturbed`: the largest singular value of P, by
/// differences of whole motions, one for each free coordinate and its velocity. For small sheets, to check the others by.
double largest_growth(const solver::SplitOde& ode, const solver::State& y0, double t0, const Trajectory& unperturbed,
                      double size, const SolveFrom& solve);

/// The growth of one perturbation of the start, by 1e-7 size along a direction of size 1. From 1e-5 size on, folding sheets
/// saturate.
Growth growth_along(const solver::State& direction, const solver::State& y0, const Trajectory& unperturbed, double size,
                    const SolveFrom& solve);

/// Measures the growth of a perturbation of the start: of the one that grows most, by one more trajectory. So the factors are a
/// lower bound of the largest ones, whatever the linearised motion is worth.
///
/// With contacts the motion has no derivative: there the growth is the larger of two perturbations, normal noise, and what that
/// has become at the end.
Growth measure_growth(const solver::SplitOde& ode, const solver::State& y0, double t0, const Trajectory& unperturbed,
                      double size, const SolveFrom& solve);

}  // namespace drape::reference
