#pragma once

#include <span>
#include <string_view>

namespace drape::reference {

/// How a general solver solves the linear systems of its Newton method.
struct NewtonSolve {
  std::string_view name;
  std::string_view description;
  enum class Matrix {
    klu,       ///< the exact matrix of positions and velocities together, factored by KLU
    newton,    ///< the one of velocities alone, with the convex part of the exact Jacobian, factored by CHOLMOD
    constant,  ///< the one of velocities alone, M − γ² K − γ D, factored once for each γ
  } matrix;
  bool gmres = false;  ///< the factor only preconditions GMRES on the exact system

  bool reduced() const { return matrix != Matrix::klu; }
};

/// All of them; the first is the default.
std::span<const NewtonSolve> newton_solves();

/// The Newton solve with this name. Throws std::invalid_argument, listing the names.
const NewtonSolve& newton_solve(std::string_view name);

}  // namespace drape::reference
