#pragma once

#include <algorithm>
#include <array>

#include "solver/stage/stage_iteration.hpp"

namespace drape::solver {

/// L-BFGS on the energy whose gradient is −r: two loops over the last eight updates, with A⁻¹ for the first inverse Hessian
/// [Liu, Bouaziz, Kavan 2017]; then backtracking until Armijo's condition holds.
///
/// The energy is not evaluated: its change along an update is the integral of the slope r(v + α d)·d, by the trapezoidal rule.
/// So forces need no potential, and the search does not drown in the round-off of a difference of energies. Where forces have
/// no potential, the same condition bounds the slope.
class Lbfgs : public StageIteration {
 public:
  Lbfgs(const SplitOde& ode, const Options& options, StageSystem& system);

 private:
  static constexpr int memory = 8;  ///< updates that are kept

  /// An update of v, and by how much r fell in it.
  struct Pair {
    Vectors step, fall;
    double curvature = 0;  ///< <step, fall>, positive
  };

  void begin(const State& y) override;
  LinearResult advance(const Stage& stage, State& y, double target) override;
  LinearResult find_direction();
  bool follow(const Stage& stage, State& y);
  void remember(const State& y);
  double slope() const;
  Pair& newest(int age) { return pairs_[(count_ - 1 - age) % memory]; }
  int kept() const { return std::min(count_, memory); }

  std::array<Pair, memory> pairs_;
  int count_ = 0;  ///< pairs since the iteration began
  std::array<double, memory> parts_{};
  Vectors from_, r_, q_, d_;  ///< v and r where the update begins, a work space, the direction
};

}  // namespace drape::solver
