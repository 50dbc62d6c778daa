#pragma once

#include <cstdint>
#include <optional>

#include "solver/options.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// Which matrix accelerated stages begin with; and when the stage solver `auto` leaves the constant matrix for Newton's, and
/// for how long. Costs are in updates with the constant matrix, as measured on sheets of 20 × 20 to 100 × 100 particles.
class AutoPolicy {
 public:
  AutoPolicy(StageKind::Matrix matrix, const SplitOde& ode)
      : matrix_(matrix),
        may_switch_(matrix == StageKind::Matrix::chosen && ode.newton_matrix),
        switches_(ode.work->counter("escalations", "stages that auto gave to Newton's matrix")) {}

  /// The Newton matrix that the next stage begins with; absent: the constant matrix.
  std::optional<Jacobian> first_matrix() const;

  /// Whether stages may go over from the constant matrix to Newton's.
  bool may_switch() const { return may_switch_; }

  /// Whether a stage that has taken this number of updates with the constant matrix should go over.
  static bool too_long(int updates) { return updates >= most_constant_updates; }

  /// Whether the springs make A so stiff that its update, of this size, does not show the errors of modes in which the cloth is
  /// slack. `mass_scaled`: the size of the update without springs.
  static bool hides_errors(double size, double mass_scaled) { return mass_scaled > stiffest * size; }

  /// A stage has gone over to Newton's matrix.
  void switched();

  /// A stage has ended: the next ones stay with Newton's matrix for a while, and longer where they are cheap.
  void ended(int updates, int renewals);

 private:
  static constexpr int most_constant_updates = 150;  ///< the cost of a hard stage with Newton's matrix
  static constexpr double stiffest = 1e4;            ///< A over A without springs, beyond which its updates are not trusted
  static constexpr int update_cost = 4;              ///< an update with a Newton matrix
  static constexpr int renewal_cost = 40;            ///< evaluating and factoring a Newton matrix
  static constexpr double newest_weight = 0.2;       ///< of the newest stage in the mean cost: about five stages count
  static constexpr int first_stay = 4;               ///< stages after the first switch,
  static constexpr int longest_stay = 64;            ///< doubled by each, up to this; then the constant matrix is tried again
  static constexpr double cheap = 50;                ///< cost of a stage for which the constant matrix need not be tried

  const StageKind::Matrix matrix_;
  const bool may_switch_;
  int newton_stages_ = 0;  ///< left to be solved with Newton's matrix
  int next_stay_ = first_stay;
  double mean_cost_ = 0;  ///< mean over stages with Newton's matrix
  std::int64_t& switches_;
};

}  // namespace drape::solver
