#pragma once

#include <limits>

#include "solver/split_ode.hpp"

namespace drape::solver {

/// Estimate of the error of v in a stage that is solved by updates d = P⁻¹ r.
///
/// It is the larger of two: |d| divided by the smallest |Δd|/|Δv| observed in this stage; and, since the error lies between
/// |P⁻¹ r| and |M⁻¹ r|, their geometric mean. The first alone is too small where P is stiffer than the cloth that |d|
/// hardly responds to v. Both estimate the error before the update; the observed reduction of |d| from update to update gives
/// the error after it   [as in CVODE].
class ErrorEstimate {
 public:
  explicit ErrorEstimate(const SplitOde& ode);

  /// P has changed: no reduction is expected.
  void reset();

  /// The next stage has the same P: a smaller reduction is expected than was observed.
  void next_stage();

  /// The iteration of a stage begins.
  void start() { last_ = unknown; }

  /// Computes the norms of r in one pass; γ of the stage.
  void measure(const Vectors& r, double gamma);

  /// Updates the expected reduction from the size |d| of the next update: none where convergence is slow, or where a stage
  /// begins farther from its solution than the one before.
  void observe_update(double size);

  /// Error of v [m/s] after an update of this size; `smallest_response`: |Δd|/|Δv|.
  double error(double size, double smallest_response) const;

  double residual() const { return residual_; }  ///< |r|

  /// |(diag(M − γD))⁻¹ r|: the size of the update without springs.
  double mass_scaled_residual() const { return mass_scaled_; }

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  const Partition& all_;
  const Eigen::ArrayXd mass_, drag_;   ///< M and the diagonal of D, each value three times, as coordinates lie in memory
  const Eigen::ArrayXd inverse_mass_;  ///< M⁻¹ in the same way
  Eigen::ArrayXd mass_scaling_;        ///< (M − γD)⁻¹
  double gamma_ = 0;                   ///< its γ [s]
  double residual_ = 0;                ///< |r|
  double bound_ = 0;                   ///< |M⁻¹ r|
  double mass_scaled_ = 0;
  double first_ = 0, last_ = unknown;  ///< |d| of the first and of the last update of the stage
  double reduction_ = 1;               ///< expected factor of |d| from update to update
};

}  // namespace drape::solver
