#include "solver/options.hpp"

#include "solver/base/registry.hpp"

namespace drape::solver {

std::span<const StageKind> stage_kinds() {
  using Matrix = StageKind::Matrix;
  static constexpr StageKind table[] = {
      {"auto", "begins with anderson, goes on with newton where that is cheaper", Matrix::chosen, true},
      {"fixed-point", "the thesis' loop with the constant matrix (3.33)-(3.36), Alg. 6", Matrix::constant, false},
      {"anderson", "the same iteration accelerated over the last eight updates", Matrix::constant, true},
      {"newton", "with the exact Jacobian, renewed when convergence slows; factored, or inexact by conjugate gradients",
       Matrix::newton, true},
      {"tension-newton", "with the Jacobian of tension and damping, without shear and bending", Matrix::tension_newton, true},
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
