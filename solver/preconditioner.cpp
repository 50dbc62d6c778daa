#include "solver/preconditioner.hpp"

namespace drape::solver {

std::span<const LinearSolver> linear_solvers() {
  static constexpr LinearSolver table[] = {
      {"ic0", "conjugate gradients with incomplete Cholesky IC(0), as in the thesis (3.4.2)", make_incomplete_cholesky},
      {"cholesky", "conjugate gradients with the complete Cholesky factor (CHOLMOD): one iteration a solve", make_cholesky},
  };
  return table;
}

}  // namespace drape::solver
