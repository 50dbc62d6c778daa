#pragma once

#include <memory>
#include <vector>

#include "solver/linear_work.hpp"
#include "solver/outcome.hpp"
#include "solver/preconditioner.hpp"
#include "solver/split_ode.hpp"

namespace drape::solver {

struct LinearResult {
  Outcome outcome = Outcome::success;
  int iterations = 0;
};

/// Preconditioned conjugate gradients for A d = r, all three coordinates as one system, restricted to the coordinates that
/// `filtered` leaves free [Etzmuß 2002, 3.4.2 and Alg. 7].
class ConjugateGradients {
 public:
  /// `filtered`: pins whose particles still have free coordinates; the others are expected to be gone from A.
  ConjugateGradients(std::unique_ptr<Preconditioner> preconditioner, std::vector<Pin> filtered, int max_iterations, Work& work);

  /// Prepares for a pattern; allocates all that later calls need.
  void analyze(const SparseMatrix& A);

  /// Prepares for new values.
  Outcome factor(const SparseMatrix& A);

  /// Solves A d = r from d = 0 until |residual| ≤ target (Euclidean norm). r is overwritten with the residual.
  LinearResult solve(const SparseMatrix& A, Vectors& r, Vectors& d, double target);

 private:
  std::unique_ptr<Preconditioner> preconditioner_;
  std::vector<Pin> filtered_;
  int max_iterations_;
  Vectors z_, p_, q_;
  LinearWork work_;
};

}  // namespace drape::solver
