#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/run.hpp"
#include "bench/studies/verdict.hpp"
#include "model/cloth.hpp"
#include "solver/integrator.hpp"

namespace drape::solver {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunResult, outcome, message, last_good_time, steps, rejected_steps)

}  // namespace drape::solver

namespace drape::bench {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UncertainError, error, uncertainty)

/// As a unit of work it is kept without the state at its end.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunEnd, result, evaluations, newton_matrices, cpu_ms)

}  // namespace drape::bench

/// Short runs whose only question is what becomes of them.
namespace drape::bench {

/// A cloth to be tried, from its start on: compiled from its scene, but it may have been changed since.
struct Specimen {
  model::Scene scene;
  model::Cloth cloth;
};

/// How it is tried. A run may evaluate forces, or make Newton matrices, up to this number of times before it counts as not
/// finished: a limit that does not depend on the machine.
struct Conditions {
  const solver::Method* method;
  solver::Options options;
  double step;   ///< [s]
  double until;  ///< [s]
  std::int64_t budget = 10'000;
};

RunEnd attempt(const Specimen& specimen, const Conditions& conditions);

/// Why it did not succeed; empty if it did.
std::string reason(const RunEnd& end);

/// The end of a specimen as two different methods find it, and how far they differ: the first two that succeed of ESDIRK3 and
/// TR-BDF2 with controlled errors, velocity Verlet, the midpoint rule and SBDF(2) with many steps.
class CrossCheckedReference {
 public:
  /// `effort`: part of what the methods may usually cost.
  CrossCheckedReference(const Specimen& specimen, double until, double effort = 1);

  /// The same for a specimen that `run` takes to its end as it is told.
  CrossCheckedReference(const Specimen& specimen, double until, const std::function<RunEnd(const Conditions&)>& run,
                        double effort = 1);

  /// Error of a trial over the size of the scene, with what the reference itself is uncertain by: root mean square of
  /// positions, or, where that cannot be told from `bound`, the distance of the centres of mass. NaN if that cannot either.
  UncertainError measure(const RunEnd& trial, double bound) const;

  double uncertainty() const { return positions_; }  ///< of positions; NaN if there are no two

 private:
  double centre_distance(const solver::Vectors& x) const;  ///< from the truth's, over the size

  double size_;
  Eigen::VectorXd mass_;
  solver::Vectors truth_;
  double positions_, centre_;
};

}  // namespace drape::bench
