#pragma once

#include "bench/strips/programs/strip.hpp"
#include "solver/linear/preconditioner.hpp"

namespace drape::bench::strips {

/// The linear solver of the stages of a strip, whose matrices are five-point stars of the whole sheet: hypre's conjugate
/// gradients on all processes, with its multigrid cycle PFMG, to round-off and one coordinate after the other. One strip may
/// have one at a time.
solver::LinearSolver pfmg(const Strip& strip);

}  // namespace drape::bench::strips
