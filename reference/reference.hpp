#pragma once

#include "reference/distance.hpp"
#include "reference/trajectory.hpp"

namespace drape::reference {

/// A trajectory to measure others by, with its own uncertainty and the conditioning of the problem.
struct Reference {
  std::string name;            ///< the peer solver that computed the trajectory, for example "cvode-bdf"
  std::string witness;         ///< the peer solver that it was compared with
  double tolerance = 0;        ///< relative tolerance of the trajectory; with contact the step of both [s]
  std::vector<double> error;   ///< [m], uncertainty at each time, in the measure of rms_distance
  std::vector<double> growth;  ///< of a small perturbation of the start, at each time, over its size at the start
  Trajectory trajectory;
  Trajectory witnessed;  ///< trajectory of the witness
  Trajectory perturbed;  ///< trajectory from the perturbed start
};

/// An equation of motion for each of two threads. If they are one and the same, its solutions are computed one after the other;
/// else they must be equal and share no memory, as two compilations of a scene.
struct Equations {
  const solver::SplitOde& first;
  const solver::SplitOde& second;

  bool at_once() const { return &first != &second; }
};

/// Motions that the first thread computes at least: the trajectory, two about which is linearised, and a perturbed one. The
/// second computes one.
inline constexpr int first_motions = 4;

/// Solves with two families at once, CVODE's BDF at the given rtol and ARKODE's ESDIRK at 10 rtol, whose errors are smaller
/// still. Their disagreement is the uncertainty. At a single time two solutions may meet by chance, so prefer its maximum over
/// several. Where one of the two stops, IDA takes its place. Newton systems are solved by our own factors; where these do not
/// do, by KLU on the exact Jacobian, counted as "reference/klu_fallbacks". The Newton solve of `options` has no meaning here.
///
/// The conditioning is the growth of a small perturbation of the start, made so that it grows most (growth.hpp).
/// Arguments and exceptions as for cvode().
Reference reference(const Equations& equations, const solver::State& y0, double t0, std::span<const double> times,
                    const SolveOptions& options = {});

/// The same for scenes with contact, which the general solvers cannot solve: velocity Verlet with impulses and the implicit
/// midpoint rule with constraints, two responses that share no code, each with steps of 0.5 and 1 ms. Both are of first order
/// in contact, so the uncertainty is the largest of their disagreement and of what doubling the steps changed. The rtol of
/// `options` has no meaning here. Throws ReferenceError if a run fails.
Reference contact_reference(const Equations& equations, const solver::State& y0, double t0, std::span<const double> times,
                            const SolveOptions& options = {});

/// Both for one equation.
inline Reference reference(const solver::SplitOde& ode, const solver::State& y0, double t0, std::span<const double> times,
                           const SolveOptions& options = {}) {
  return reference(Equations{ode, ode}, y0, t0, times, options);
}
inline Reference contact_reference(const solver::SplitOde& ode, const solver::State& y0, double t0,
                                   std::span<const double> times, const SolveOptions& options = {}) {
  return contact_reference(Equations{ode, ode}, y0, t0, times, options);
}

/// The two families of a reference are farther apart than allowed.
class NotCertified : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws NotCertified if the families disagree by more than `agreement` times the size [m] of the scene at any time, unless
/// perturbations have grown by more than `largest_growth` until then: disagreement is to be expected there.
void certify(const Reference& reference, double agreement, double largest_growth, double size);

}  // namespace drape::reference
