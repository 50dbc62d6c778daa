#include "solver/linear/preconditioner.hpp"

#include "solver/base/registry.hpp"

namespace drape::solver {

std::span<const LinearSolver> linear_solvers() {
  using Newton = LinearSolver::Newton;
  static constexpr LinearSolver table[] = {
      {.name = "auto",
       .description = "the quickest of the others by size and stiffness of the matrix",
       .make = make_automatic,
       .newton = Newton::by_size},
      {.name = "ic0",
       .description = "conjugate gradients with incomplete Cholesky IC(0), as in the thesis (3.4.2)",
       .make = make_incomplete_cholesky},
      {.name = "mic0",
       .description = "conjugate gradients with modified incomplete Cholesky, which keeps row sums",
       .make = make_modified_incomplete_cholesky},
      {.name = "cholesky",
       .description =
           "the complete Cholesky factor (CHOLMOD); in conjugate gradients where contacts or pins leave directions free",
       .make = make_cholesky,
       .newton = Newton::factored},
      {.name = "multigrid",
       .description = "conjugate gradients with a multigrid cycle where the scene is a grid, else as mic0",
       .make = make_multigrid},
      {.name = "cg", .description = "conjugate gradients without a preconditioner", .make = make_unpreconditioned},
      {.name = "jacobi", .description = "conjugate gradients with the diagonal, as Baraff and Witkin", .make = make_jacobi},
  };
  return table;
}

const LinearSolver& linear_solver(std::string_view name) { return base::find_named(linear_solvers(), "linear solver", name); }

}  // namespace drape::solver
