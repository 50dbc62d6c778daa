#pragma once

#include "solver/split_ode.hpp"

namespace drape::solver {

/// A = M − γ² K − γ D, N × N, with all couplings of pinned particles.
SparseMatrix stage_matrix(const SplitOde& ode, double gamma);

}  // namespace drape::solver
