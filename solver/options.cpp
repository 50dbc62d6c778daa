#include "solver/options.hpp"

#include "solver/base/registry.hpp"

namespace drape::solver {

std::span<const StageKind> stage_kinds() {
  using Matrix = StageKind::Matrix;
  using Iteration = StageKind::Iteration;
  static constexpr StageKind table[] = {
      {.name = "auto",
       .description = "begins with anderson, goes on with newton where that is cheaper",
       .matrix = Matrix::chosen,
       .accelerated = true},
      {.name = "fixed-point",
       .description = "the thesis' loop with the constant matrix (3.33)-(3.36), Alg. 6",
       .matrix = Matrix::constant},
      {.name = "anderson",
       .description = "the same iteration accelerated over the last eight updates",
       .matrix = Matrix::constant,
       .accelerated = true},
      {.name = "newton",
       .description = "with the exact Jacobian, renewed when convergence slows; factored, or inexact by conjugate gradients",
       .matrix = Matrix::newton,
       .accelerated = true},
      {.name = "tension-newton",
       .description = "with the Jacobian of tension and damping, without shear and bending",
       .matrix = Matrix::tension_newton,
       .accelerated = true},
      {.name = "projective",
       .description = "projective dynamics: ten passes of the loop, which are its local and global steps",
       .matrix = Matrix::constant,
       .passes = 10},
      {.name = "printed-loop",
       .description = "Alg. 6 to the letter: one tolerance, until CG takes no iteration",
       .matrix = Matrix::constant,
       .iteration = Iteration::printed_loop},
      {.name = "chebyshev",
       .description = "the loop with Chebyshev's weights, for a spectral radius of 0.97",
       .matrix = Matrix::constant,
       .iteration = Iteration::chebyshev},
      {.name = "lbfgs",
       .description = "L-BFGS over the last eight updates, begun with the constant matrix",
       .matrix = Matrix::constant,
       .iteration = Iteration::lbfgs},
      {.name = "vbd",
       .description = "vertex block descent: Gauss-Seidel over particles, with Chebyshev's weights",
       .matrix = Matrix::constant,
       .iteration = Iteration::vertices},
  };
  return table;
}

const StageKind& stage_kind(std::string_view name) { return base::find_named(stage_kinds(), "stage solver", name); }

Options thesis_options() {
  Options options;
  options.stage = &stage_kind("fixed-point");
  options.linear_solver = &linear_solver("ic0");
  return options;
}

}  // namespace drape::solver
