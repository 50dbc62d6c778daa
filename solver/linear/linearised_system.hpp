#pragma once

#include <optional>

#include "solver/linear/block_jacobi.hpp"
#include "solver/linear/counters.hpp"
#include "solver/linear/klu_factor.hpp"
#include "solver/outcome.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

/// The equation of motion linearised at a state, with its exact Jacobian: A = M − γ ∂f/∂v − γ² ∂f/∂x, 3N × 3N, in general not
/// symmetric, factored by KLU. Rows and columns of pinned coordinates are those of the identity.
///
/// After the first factorisation no call allocates unless the pattern of the Jacobian changes.
class LinearisedSystem {
 public:
  explicit LinearisedSystem(const SplitOde& ode);

  /// Makes A of the Jacobian at (t, y) and factors it.
  Outcome factor(double gamma, double t, const State& y);

  /// Makes A of the Jacobian at (t, y), for `solve_symmetric`.
  Outcome assemble(double gamma, double t, const State& y);

  /// Solves ½ (A + Aᵀ) d = r to |residual| ≤ tolerance |r|, by block-Jacobi preconditioned conjugate gradients; d = 0 in pinned
  /// coordinates, whose rows and columns are those of the identity: the filter of Algorithm 7.
  LinearResult solve_symmetric(const Vectors& r, double tolerance, int max_iterations, Vectors& d);

  /// f = ∂f/∂x x.
  void multiply_stiffness(const Vectors& x, Vectors& f);

  /// d = A⁻¹ r, all N × 3; d = 0 in pinned coordinates. Counts as an update.
  void solve(const Vectors& r, Vectors& d);

  /// (1 − γ J) k = r with J the Jacobian of (v, M⁻¹ f): A k_v = M r_v + γ ∂f/∂x r_x,   k_x = r_x + γ k_v.
  void solve(const State& r, State& k);

 private:
  Outcome make(double gamma, double t, const State& y);
  void merge_derivatives();

  const SplitOde& ode_;
  std::vector<bool> pinned_;  ///< 3N
  SparseMatrix free_, held_;  ///< projector on the directions that oblique pins leave, and the mass in theirs; or empty
  SparseMatrix df_dx_, df_dv_, A_;
  Vectors right_;
  double gamma_ = 0;
  KluFactor klu_;
  std::optional<BlockJacobiGradients> gradients_;  ///< from the first `assemble` on
  LinearCounters work_;
};

}  // namespace drape::solver
