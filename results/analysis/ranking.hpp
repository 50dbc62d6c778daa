#pragma once

#include "results/table.hpp"

namespace drape::results {

/// Who is how quick over several scenes, from their tables of trials as `study work-precision` has them: a row for each method
/// with automatic stages and linear solvers (the column `method`) and each error of 1e-1 to 1e-7. Its ratios are the time of
/// its quickest trial with an error of at most that, over the time of the quickest of all of ours: their geometric mean, the
/// least and the largest over the scenes in which it reached the error. NaN if it reached it in none.
///
/// Counted is a scene in which any of ours reaches the error and the reference resolves it, its uncertainty being at most 0.3
/// of it. Only trials that were timed repeatedly count. Tables of other names are left out.
Table ranking(std::span<const Table> tables);

}  // namespace drape::results
