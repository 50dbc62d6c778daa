#pragma once

#include <array>

#include "solver/state.hpp"

namespace drape::solver {

/// Anderson acceleration of a fixed-point iteration v ← v + d(v): of all combinations of the last iterates it takes the one
/// whose linearised d is smallest   [Anderson 1965; Walker, Ni 2011, type II].
class Anderson {
 public:
  static constexpr int depth = 8;  ///< past differences that are kept

  /// The fields are N × 3.
  explicit Anderson(Eigen::Index particles);

  /// Forgets the past: the fixed point is another one now.
  void restart() { count_ = 0; }

  /// Smallest |Δd|/|Δv| of the past differences: what is left of a change of v in the update it makes. |d| over it is an
  /// estimate of the error of v.
  double weakest() const;

  /// Replaces v by the next iterate; d: its update without acceleration, replaced by the accelerated one.
  void advance(Vectors& v, Vectors& d);

 private:
  using Gram = Eigen::Matrix<double, depth, depth>;

  void remember(const Vectors& v, const Vectors& d);

  int count_ = 0;  ///< iterates since the restart
  Vectors v_, d_;  ///< of the iteration before
  std::array<Vectors, depth> dv_, dd_;
  std::array<double, depth> length_{};  ///< |Δv_i|
  Gram gram_ = Gram::Zero();            ///< <Δd_i, Δd_j>
};

}  // namespace drape::solver
