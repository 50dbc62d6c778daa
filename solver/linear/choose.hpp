#pragma once

namespace drape::solver {

/// Sizes in particles up to which `auto` chooses direct solvers, as measured (`study scaling` shows some of it).
struct LinearChoice {
  /// Up to 150 × 150 a substitution takes less time than two multigrid cycles; at 200 × 200 the factorisation no longer pays
  /// over about a hundred solves with one matrix.
  static constexpr int most_factored = 25'000;

  /// The same where the matrix is not a grid's, so that multigrid is not an alternative.
  static constexpr int most_factored_without_grid = 200'000;

  /// Newton matrices. From 30 × 30 on conjugate gradients take two thirds to a third of the factor's time on lightly damped
  /// sheets; on undamped ones of numerical stiffness 1e7, where springs are slack, they take twice its time there and about the
  /// same at 100 × 100.
  static constexpr int most_factored_newton = 2'500;

  /// Numerical stiffness below which two or three iterations suffice, however large the sheet is.
  static constexpr double soft = 1;
};

}  // namespace drape::solver
