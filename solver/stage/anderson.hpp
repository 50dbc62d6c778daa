#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/partition.hpp"

namespace drape::solver {

/// Anderson acceleration of a fixed-point iteration v ← v + d(v): of all combinations of the last iterates it takes the one
/// whose linearised d is smallest   [Anderson 1965; Walker, Ni 2011, type II]. Only the constructor allocates.
class Anderson {
 public:
  static constexpr int depth = 8;  ///< past differences that are kept

  /// The fields are N × 3.
  explicit Anderson(Eigen::Index particles, const Partition& all = *Partition::of_one_process());

  /// Past differences of a smaller response than this are not used in the next stage: slack directions may be taut then,
  /// while stiff directions hardly turn from step to step.
  static constexpr double lasting_response = 0.2;

  /// Discards all differences, for another iteration.
  void restart() {
    pairs_ = 0;
    follows_ = false;
  }

  /// The same iteration towards another fixed point, as in the next time step: past differences are kept, none is taken across
  /// [Degroote, Bathe, Vierendeels 2009, reuse of time steps].
  void begin();

  /// Replaces v by the next iterate; d: its update without acceleration, replaced by the accelerated one.
  void advance(Vectors& v, Vectors& d);

  /// The smallest |Δd|/|Δv| of the past differences: the response of the update to a change of v. |d| divided by it estimates
  /// the error of v.
  double smallest_response() const;

 private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, depth>;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, depth, 1>;
  using Gram = Eigen::Matrix<double, depth, depth>;

  int kept() const { return std::min(pairs_, depth); }
  double response(int slot) const { return std::sqrt(gram_(slot, slot)) / lengths_[slot]; }
  void remember(const Vectors& v, const Vectors& d);
  void add_pair(const double* v, const double* d);
  Small weights() const;

  const Partition& all_;
  int pairs_ = 0;                                          ///< differences taken since the restart
  bool follows_ = false;                                   ///< whether the next iterate follows the last
  Eigen::VectorXd v_, d_;                                  ///< of the last iterate, as they lie in memory
  Columns dd_, dg_;                                        ///< Δd and Δ(v + d)
  Gram gram_ = Gram::Zero();                               ///< <Δd_i, Δd_j>
  Eigen::Matrix<double, depth, 1> projections_, lengths_;  ///< <Δd_i, d>, |Δv_i|
  std::array<bool, depth> serves_{};                       ///< whether a difference takes part
};

}  // namespace drape::solver
