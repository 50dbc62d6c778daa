#include "solver/linear/preconditioner.hpp"

#include "solver/base/registry.hpp"

namespace drape::solver {

std::span<const LinearSolver> linear_solvers() {
  static constexpr LinearSolver table[] = {
      {"auto", "the quickest of the others by size and stiffness of the matrix", make_automatic, LinearSolver::Newton::by_size},
      {"ic0", "conjugate gradients with incomplete Cholesky IC(0), as in the thesis (3.4.2)", make_incomplete_cholesky},
      {"mic0", "conjugate gradients with modified incomplete Cholesky, which keeps row sums",
       make_modified_incomplete_cholesky},
      {"cholesky",
       "the complete Cholesky factor (CHOLMOD); in conjugate gradients where contacts or pins leave directions free",
       make_cholesky, LinearSolver::Newton::factored},
      {"multigrid", "conjugate gradients with a multigrid cycle where the scene is a grid, else as mic0", make_multigrid},
  };
  return table;
}

const LinearSolver& linear_solver(std::string_view name) { return base::find_named(linear_solvers(), "linear solver", name); }

}  // namespace drape::solver
