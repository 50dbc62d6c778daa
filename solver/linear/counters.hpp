#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "solver/counters.hpp"
#include "solver/linear/choose.hpp"
#include "solver/linear/preconditioner.hpp"

namespace drape::solver {

/// The counters of the linear algebra, in one place because the stage solver and conjugate gradients share them.
struct LinearCounters {
  explicit LinearCounters(Counters& work)
      : updates(work.counter("updates", "linear systems solved, one an update of the fixed-point loop")),
        cg_iterations(work.counter("cg_iterations", "iterations of conjugate gradients")),
        products(work.counter("matrix_products", "products of a matrix with an N x 3 vector field")),
        jacobian_products(work.counter("jacobian_products", "products of the exact Jacobian with a state, in Krylov spaces")),
        preconditioner(work.counter("preconditioner_applications", "applications of the preconditioner")),
        builds(work.counter("matrix_builds", "assemblies of the constant matrix A")),
        factorisations(work.counter("factorisations", "factorisations of A, complete or incomplete")),
        entries(work.counter("matrix_entries", "entries of A")),
        bytes(work.counter("linear_bytes", "bytes that the linear algebra moved, every array counted once a pass")) {
    for (const LinearSolver& solver : linear_solvers())
      kinds_.emplace_back(solver.name, &work.counter("linear_solver/" + std::string(solver.name),
                                                     "factorisations for: " + std::string(solver.description)));
    for (const LinearReason& reason : linear_reasons)
      reasons_.emplace_back(reason.name, &work.counter("linear_choice/" + std::string(reason.name),
                                                       "factorisations by `auto`: " + std::string(reason.description)));
  }

  /// Counts a factorisation under its solver, and the reason if there was a choice.
  void count_factorisation(const Preconditioner& by) const {
    ++factorisations;
    ++*count_of(kinds_, by.name());
    if (!by.reason().empty()) ++*count_of(reasons_, by.reason());
  }

  std::int64_t &updates, &cg_iterations, &products, &jacobian_products, &preconditioner, &builds, &factorisations, &entries,
      &bytes;

 private:
  using Counts = std::vector<std::pair<std::string_view, std::int64_t*>>;

  static std::int64_t* count_of(const Counts& counts, std::string_view name) {
    return std::ranges::find(counts, name, &Counts::value_type::first)->second;
  }

  Counts kinds_, reasons_;  ///< which linear solver it was in the end, and why
};

}  // namespace drape::solver
