#pragma once

#include <cstdint>

#include "solver/counters.hpp"

namespace drape::solver {

/// When the stage solver `auto` leaves the constant matrix for Newton's, and for how long. Costs are in updates with the
/// constant matrix, as measured on sheets of 20 × 20 to 100 × 100 particles.
class AutoPolicy {
 public:
  static constexpr int most_constant_updates = 150;  ///< what a stage costs with Newton's matrix where it is hard
  static constexpr double stiffest = 1e4;            ///< A over A without springs, beyond which its updates are not trusted

  explicit AutoPolicy(Counters& counters)
      : switches_(counters.counter("escalations", "stages that auto gave to Newton's matrix")) {}

  /// Whether the next stage begins with Newton's matrix.
  bool prefers_newton() const { return newton_stages_ > 0; }

  /// A stage has gone over to Newton's matrix.
  void switched();

  /// A stage has ended: it stays with Newton's matrix for some stages, and longer where these were cheap.
  void ended(int updates, int renewals);

 private:
  static constexpr int update_cost = 4;    ///< of an update with a Newton matrix
  static constexpr int renewal_cost = 40;  ///< of making it
  static constexpr int longest_stay = 64;  ///< stages after which the constant matrix is tried again
  static constexpr double cheap = 50;      ///< cost of a stage for which the constant matrix need not be tried

  int newton_stages_ = 0;  ///< still to be solved with Newton's matrix
  int next_stay_ = 4;
  double mean_cost_ = 0;  ///< of a stage with Newton's matrix
  std::int64_t& switches_;
};

}  // namespace drape::solver
