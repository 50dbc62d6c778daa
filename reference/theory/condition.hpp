#pragma once

#include <span>

#include "solver/linear/preconditioner.hpp"
#include "solver/split_ode.hpp"

/// The condition of a stage's constant matrix A = M − γ² K − γ D, in closed form and from the iterations of conjugate
/// gradients.
namespace drape::reference {

/// What of a square sheet's border is pinned.
enum class PinnedBorder { none, one_edge, all };

/// The extreme eigenvalues of a matrix.
struct ExtremeEigenvalues {
  double least, largest;

  double condition() const { return largest / least; }
};

/// Those of M^-1/2 A M^-1/2 for a square sheet of n × n particles, n ≥ 3, with tension and linear damping only and the masses
/// and widths of dual cells: 1 + g μ, where μ are the eigenvalues of the sheet's five-point stars.
///
/// g = γ² k/(ρ l²) + γ d/(ρ l²): c² ν_h + c δ_h with γ = c h   [Etzmuß 2002, 3.4.2]. Pinned particles do not count.
ExtremeEigenvalues stage_eigenvalues(int n, double g, PinnedBorder pinned);

/// ½ √κ ln(2/ε): a number of iterations of conjugate gradients after which the error in the norm of A is at most ε times what
/// it was   [Etzmuß 2002, (3.7)].
double sufficient_iterations(double condition, double reduction);

/// M − γ² K − γ D without the couplings of particles that are pinned in all directions.
solver::SparseMatrix stage_matrix(const solver::SplitOde& ode, double gamma);

/// A run of conjugate gradients on A d = r with a known solution.
struct KrylovRun {
  int iterations = 0;  ///< after which the error in the norm of A is at most `reduction` times what it was; 0: none
  ExtremeEigenvalues eigenvalues{};  ///< of P⁻¹ A, P being the preconditioner: Ritz values of the Lanczos process
};

/// Goes on to round-off, so that the Ritz values settle. `solution`: N × 3, with components along all eigenvectors. The
/// preconditioner must have been factored for A.
KrylovRun krylov_run(const solver::SparseMatrix& A, solver::Preconditioner& preconditioner, const solver::Vectors& solution,
                     double reduction);

/// Extreme eigenvalues from the coefficients of conjugate gradients: α_k the step lengths, β_k = <r, z> of iteration k + 1 over
/// that of k. They are those of the tridiagonal T with T_kk = 1/α_k + β_(k−1)/α_(k−1) and T_(k,k+1) = √β_k/α_k.
ExtremeEigenvalues ritz_values(std::span<const double> alpha, std::span<const double> beta);

}  // namespace drape::reference
