#pragma once

#include <functional>
#include <limits>
#include <string>

#include "bench/runs/checkpoint_json.hpp"
#include "bench/runs/run.hpp"
#include "model/cloth.hpp"

namespace drape::bench {

/// Why it did not succeed; empty if it did.
std::string reason(const RunEnd& end);

/// A scene and its cloth, which may have been changed since it was compiled.
struct CompiledScene {
  model::Scene scene;
  model::Cloth cloth;
};

/// An error known up to an uncertainty; NaN: not known.
struct UncertainError {
  double error = std::numeric_limits<double>::quiet_NaN();
  double uncertainty = std::numeric_limits<double>::quiet_NaN();
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UncertainError, error, uncertainty)

/// The end of a cloth's motion as two different methods find it, and how far they differ: the first two that succeed of ESDIRK3
/// and TR-BDF2 with controlled errors, velocity Verlet, the midpoint rule and SBDF(2) with many steps.
class CrossCheckedReference {
 public:
  /// Runs a method to the end of its scene.
  using Run = std::function<RunEnd(const RunSpec&, const Limits&)>;

  /// `effort`: part of what the methods may usually cost.
  explicit CrossCheckedReference(const CompiledScene& sheet, double effort = 1);

  /// The same with runs other than those under the energy guard.
  CrossCheckedReference(const CompiledScene& sheet, const Run& run, double effort = 1);

  /// Error of a run over the size of the scene, with what the reference itself is uncertain by: root mean square of positions,
  /// or, where that cannot be told from `bound`, the distance of the centres of mass. NaN if that cannot either.
  UncertainError measure(const RunEnd& end, double bound) const;

  double uncertainty() const { return positions_; }  ///< of positions; NaN if there are no two

 private:
  double centre_distance(const solver::Vectors& x) const;  ///< from the truth's, over the size

  double size_;
  Eigen::VectorXd mass_;
  solver::Vectors truth_;
  double positions_, centre_;
};

}  // namespace drape::bench
