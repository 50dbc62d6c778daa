#pragma once

#include <functional>

#include "bench/strips/problem.hpp"
#include "bench/strips/programs/strip.hpp"

namespace drape::bench::strips {

/// Steps a strip to multiples of Problem::step by CVODE on NVECTOR_PARALLEL, of the unknowns of own particles: BDF with GMRES,
/// whose preconditioner is M − γ D − γ² K solved by PFMG; or Adams' formulas with functional iteration ("cvode-adams"). Its own
/// steps end where it likes. `between` is called after each multiple. Returns the state at the end. Throws ReferenceError.
solver::State run_cvode(const Strip& strip, const Problem& problem, const std::function<void()>& between);

}  // namespace drape::bench::strips
