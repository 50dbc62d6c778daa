#pragma once

#include <string_view>

namespace drape::solver {

/// Sizes in particles up to which `auto` chooses direct solvers, as measured (`study scaling` shows some of it).
struct LinearChoice {
  /// Up to 150 × 150 a substitution takes less time than two multigrid cycles; at 200 × 200 the factorisation no longer pays
  /// over about a hundred solves with one matrix.
  static constexpr int most_factored = 25'000;

  /// The same where the matrix is not a grid's, so that multigrid is not an alternative, and where coefficients vary: on a
  /// half-circle skirt of 481 × 161 particles multigrid takes 9 to 22 iterations a step instead of 4, and 30 steps 1.6 to 3
  /// times as long as with the factor.
  static constexpr int most_factored_without_grid = 200'000;

  /// Newton matrices. On lightly damped sheets factors take two thirds of the time of conjugate gradients at 50 × 50 and
  /// nine tenths at 100 × 100; on undamped ones 1.6 to 2.1 times as long at 50 × 50 and 70 × 70.
  static constexpr int most_factored_newton = 2'500;

  /// Numerical stiffness below which two or three iterations suffice, however large the sheet is.
  static constexpr double soft = 1;
};

/// Why `auto` takes a linear solver; the counters "linear_choice/..." have it.
struct LinearReason {
  std::string_view name, description;
};

constexpr LinearReason linear_reasons[] = {
    {"small", "cholesky, since there are few particles"},
    {"soft", "mic0, since two or three iterations suffice"},
    {"grid", "multigrid, since the matrix is the five-point star of a grid"},
    {"varying", "cholesky, since the coefficients of the star vary too much for multigrid"},
    {"no-grid", "cholesky, since the matrix is not that of one grid, as where panels are sewn"},
    {"large", "mic0, since the matrix is not that of one grid and too large for a factor"},
};

}  // namespace drape::solver
