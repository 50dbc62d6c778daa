#pragma once

#include <algorithm>

#include "solver/state.hpp"

namespace drape::solver {

/// Anderson acceleration of a fixed-point iteration v ← v + d(v): of all combinations of the last iterates it takes the one
/// whose linearised d is smallest   [Anderson 1965; Walker, Ni 2011, type II]. Only the constructor allocates.
class Anderson {
 public:
  static constexpr int depth = 8;  ///< past differences that are kept

  /// The fields are N × 3.
  explicit Anderson(Eigen::Index particles);

  /// Forgets the past: the fixed point is another one now.
  void restart() { count_ = 0; }

  /// Replaces v by the next iterate; d: its update without acceleration, replaced by the accelerated one.
  void advance(Vectors& v, Vectors& d);

  /// Smallest |Δd|/|Δv| of the past differences: what is left of a change of v in the update it makes. |d| over it is an
  /// estimate of the error of v.
  double weakest() const;

 private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, depth>;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, depth, 1>;
  using Gram = Eigen::Matrix<double, depth, depth>;

  int kept() const { return std::min(count_ - 1, depth); }
  void remember(const Eigen::Ref<const Eigen::VectorXd>& v, const Eigen::Ref<const Eigen::VectorXd>& d);
  Small weights() const;

  int count_ = 0;                                          ///< iterates since the restart
  Eigen::VectorXd v_, d_;                                  ///< of the last iterate, as they lie in memory
  Columns dd_, dg_;                                        ///< Δd and Δ(v + d)
  Gram gram_ = Gram::Zero();                               ///< <Δd_i, Δd_j>
  Eigen::Matrix<double, depth, 1> projections_, lengths_;  ///< <Δd_i, d>, |Δv_i|
};

}  // namespace drape::solver
