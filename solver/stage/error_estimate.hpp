#pragma once

#include <limits>

#include "solver/split_ode.hpp"

namespace drape::solver {

/// What is known of the error of v in a stage that is solved by updates d = P⁻¹ r.
///
/// There are two estimates of it: |d| over the smallest response seen to a change of v; and, since the error lies between
/// |P⁻¹ r| and |M⁻¹ r|, their geometric mean. The first alone is too small where P is so much stiffer than the cloth that no
/// response is seen. Both are of the error before the update; what was seen of updates tells what they leave of it   [as in
/// CVODE].
class ErrorEstimate {
 public:
  explicit ErrorEstimate(const SplitOde& ode);

  /// Another P: nothing is known of what an update leaves.
  void reset();

  /// The next stage has the same P: what was seen counts for less.
  void next_stage();

  /// The iteration of a stage begins.
  void start() { last_ = unknown; }

  /// Takes the norms of r in one pass; γ of the stage.
  void measure(const Vectors& r, double gamma);

  /// Learns from the size |d| of the next update by what an update reduces it: nothing where convergence is slow, or where a
  /// stage begins farther off than the one before.
  void see_update(double size);

  /// Of v after an update of this size, if the smallest response was this.
  double error(double size, double smallest_response) const;

  double residual() const { return residual_; }  ///< |r|

  /// |r| scaled by M − γD, of which only the diagonal counts: the update without springs.
  double mass_scaled_residual() const { return mass_scaled_; }

 private:
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  const Eigen::ArrayXd mass_, drag_;   ///< M and the diagonal of D, each value three times, as coordinates lie in memory
  const Eigen::ArrayXd inverse_mass_;  ///< M⁻¹ in the same way
  Eigen::ArrayXd mass_scaling_;        ///< (M − γD)⁻¹
  double gamma_ = 0;                   ///< its γ [s]
  double residual_ = 0;                ///< |r|
  double bound_ = 0;                   ///< |M⁻¹ r|
  double mass_scaled_ = 0;
  double first_ = 0, last_ = unknown;  ///< |d| of the first and of the last update of the stage
  double reduction_ = 1;               ///< by which an update reduces |d|, as seen last
};

}  // namespace drape::solver
