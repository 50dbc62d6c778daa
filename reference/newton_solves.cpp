#include "reference/newton_solves.hpp"

#include "solver/base/registry.hpp"

namespace drape::reference {

std::span<const NewtonSolve> newton_solves() {
  using Matrix = NewtonSolve::Matrix;
  static constexpr NewtonSolve table[] = {
      {.name = "klu", .description = "KLU on positions and velocities, together", .matrix = Matrix::klu},
      {.name = "newton",
       .description = "CHOLMOD on the velocities, with the convex part of the Jacobian",
       .matrix = Matrix::newton},
      {.name = "constant", .description = "CHOLMOD on the velocities, with the constant matrix", .matrix = Matrix::constant},
      {.name = "newton-gmres", .description = "GMRES preconditioned by the former", .matrix = Matrix::newton, .gmres = true},
      {.name = "constant-gmres",
       .description = "GMRES preconditioned by the constant matrix",
       .matrix = Matrix::constant,
       .gmres = true},
  };
  return table;
}

const NewtonSolve& newton_solve(std::string_view name) { return base::find_named(newton_solves(), "Newton solve", name); }

}  // namespace drape::reference
