#pragma once

#include "solver/stage/newton_search.hpp"
#include "solver/stage/newton_system.hpp"

namespace drape::solver {

/// The Newton matrices of accelerated stages, each kept over updates and stages until convergence slows.
class LaggedNewton {
 public:
  /// Throws std::invalid_argument if the options ask for Newton's method and the ODE has no newton_matrix.
  LaggedNewton(const SplitOde& ode, const Options& options, StageSystem& system);

  /// The matrix in use; null if it is the constant one.
  const NewtonSystem* matrix() const { return matrix_; }
  bool in_use() const { return matrix_ != nullptr; }

  /// A stage begins, with the constant matrix.
  void begin();

  /// Chooses a matrix. True if it is kept from before, for a γ near enough; else it needs renewal.
  bool choose(Jacobian part, double gamma);

  /// Evaluates the matrix in use at (ax + γ v, v).
  Outcome renew(const Stage& stage, State& y);

  /// P d = r; both N × 3.
  LinearResult solve(const Vectors& r, Vectors& d) { return matrix_->solve(r, d); }

  void count_update() { ++updates_; }

  /// Whether the matrix should be renewed. `rate`: of convergence; `improved`: whether |d| has fallen since the iteration
  /// began.
  bool stagnates(double rate, bool improved) const;

  /// Whether renewals do not help this stage, so that every update needs a matrix.
  bool exhausted() const;

  /// The rest of the stage by Newton's method with line searches; guess: where the stage began.
  void search(const Stage& stage, const Vectors& guess, State& y, StageResult& result);

  /// Matrices that were evaluated in this stage.
  int renewals() const { return renewals_; }

 private:
  NewtonSystem& system(Jacobian part) { return part == Jacobian::tension ? tension_ : whole_; }

  NewtonSystem whole_, tension_;
  NewtonSearch search_;
  NewtonSystem* matrix_ = nullptr;
  int updates_ = 0;  ///< since the renewal, or since the stage began
  int renewals_ = 0;
};

}  // namespace drape::solver
