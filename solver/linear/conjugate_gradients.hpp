#pragma once

#include <memory>
#include <optional>

#include "solver/filter.hpp"
#include "solver/linear/counters.hpp"
#include "solver/linear/five_point.hpp"
#include "solver/linear/preconditioner.hpp"
#include "solver/outcome.hpp"

namespace drape::solver {

struct LinearResult {
  Outcome outcome = Outcome::success;
  int iterations = 0;
};

/// Preconditioned conjugate gradients for A d = r, all three coordinates as one system [Etzmuß 2002, 3.4.2].
class ConjugateGradients {
 public:
  ConjugateGradients(std::unique_ptr<Preconditioner> preconditioner, int max_iterations, Counters& work);

  /// Prepares for a pattern; no later call allocates.
  void analyse(const SparseMatrix& A);

  /// Prepares for new values.
  Outcome factor(const SparseMatrix& A);

  /// Solves P A P d = r from d = 0 until |residual| ≤ target (Euclidean norm), where P is the filter and P r = r
  /// [Etzmuß 2002, Alg. 7]: d lies in the free directions. r is overwritten with the residual.
  ///
  /// A is the matrix that was factored last. If the factor is exact and the filter empty, there is one substitution and no
  /// iteration, and the residual is set to 0.
  LinearResult solve(const SparseMatrix& A, const Filter& filter, Vectors& r, Vectors& d, double target);

  /// z ≈ P A⁻¹ r for the matrix that was factored last and P r = r. Returns <r, z>.
  double precondition(const Filter& filter, const Vectors& r, Vectors& z);

 private:
  LinearResult solve_exactly(Vectors& r, Vectors& d);
  double update_direction(const SparseMatrix& A, double beta);
  std::int64_t direction_bytes(const SparseMatrix& A) const;

  std::unique_ptr<Preconditioner> preconditioner_;
  int max_iterations_;
  std::optional<FivePoint> star_;  ///< the matrix that was factored last, if it is one of a grid
  Vectors z_, p_, q_;
  LinearCounters work_;
};

}  // namespace drape::solver
