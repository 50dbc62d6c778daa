#include "reference/newton_solves.hpp"

#include "solver/base/registry.hpp"

namespace drape::reference {

std::span<const NewtonSolve> newton_solves() {
  using Matrix = NewtonSolve::Matrix;
  static constexpr NewtonSolve table[] = {
      {"klu", "KLU on positions and velocities, together", Matrix::klu},
      {"newton", "CHOLMOD on the velocities, with the convex part of the Jacobian", Matrix::newton},
      {"constant", "CHOLMOD on the velocities, with the constant matrix", Matrix::constant},
      {"newton-gmres", "GMRES preconditioned by the former", Matrix::newton, true},
      {"constant-gmres", "GMRES preconditioned by the constant matrix", Matrix::constant, true},
  };
  return table;
}

const NewtonSolve& newton_solve(std::string_view name) { return base::find_named(newton_solves(), "Newton solve", name); }

}  // namespace drape::reference
