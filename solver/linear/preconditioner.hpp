#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "solver/outcome.hpp"
#include "solver/state.hpp"

namespace drape::solver {

/// Approximates the inverse of a symmetric positive definite scalar matrix that acts on all three coordinates alike.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;

  /// Prepares for a matrix with the pattern of all later ones.
  virtual void analyse(const SparseMatrix& A) = 0;

  /// Prepares for the values of A. `breakdown` if a pivot is not positive.
  virtual Outcome factor(const SparseMatrix& A) = 0;

  /// z ≈ A⁻¹ r; r, z: N × 3. Returns <r, z>.
  virtual double apply(const Vectors& r, Vectors& z) = 0;

  /// Whether z = A⁻¹ r up to round-off.
  virtual bool exact() const { return false; }

  /// Name of the linear solver that was factored last; another one than `auto` and `multigrid` where these delegate.
  virtual std::string_view name() const = 0;

  /// Name of the reason for that (`linear_reasons`); "" of one that has no choice.
  virtual std::string_view reason() const { return ""; }

  /// Bytes that one application moves at least.
  virtual std::int64_t bytes() const = 0;
};

/// A linear solver of the constant matrix: conjugate gradients with this preconditioner, which suffices alone if it is exact.
struct LinearSolver {
  std::string_view name;
  std::string_view description;
  std::unique_ptr<Preconditioner> (*make)();
  enum class Newton {
    factored,
    iterative,
    by_size
  } newton = Newton::iterative;  ///< how systems with a Newton matrix are solved
};

/// All linear solvers; the first is the default.
std::span<const LinearSolver> linear_solvers();

/// The linear solver with this name. Throws std::invalid_argument, listing the names.
const LinearSolver& linear_solver(std::string_view name);

std::unique_ptr<Preconditioner> make_incomplete_cholesky();
std::unique_ptr<Preconditioner> make_modified_incomplete_cholesky();
std::unique_ptr<Preconditioner> make_cholesky();
std::unique_ptr<Preconditioner> make_multigrid();
std::unique_ptr<Preconditioner> make_unpreconditioned();
std::unique_ptr<Preconditioner> make_jacobi();
std::unique_ptr<Preconditioner> make_automatic();

}  // namespace drape::solver
