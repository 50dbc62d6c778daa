#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "solver/counters.hpp"
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
      kinds.emplace_back(solver.name, &work.counter("linear_solver/" + std::string(solver.name),
                                                    "factorisations for: " + std::string(solver.description)));
  }

  std::int64_t& factorisations_of(std::string_view solver) const {
    return *std::ranges::find(kinds, solver, &std::pair<std::string_view, std::int64_t*>::first)->second;
  }

  std::int64_t &updates, &cg_iterations, &products, &jacobian_products, &preconditioner, &builds, &factorisations, &entries,
      &bytes;
  std::vector<std::pair<std::string_view, std::int64_t*>> kinds;  ///< which linear solver it was in the end
};

}  // namespace drape::solver
