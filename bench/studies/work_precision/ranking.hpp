#pragma once

#include "bench/studies/work_precision/tables.hpp"

namespace drape::bench {

/// Methods by their times over several scenes: a row for each method with automatic stages and linear solvers and each error of
/// 1e-1 to 1e-7. Its ratios are the time of its quickest run with an error of at most that, over the time of the quickest of
/// all of ours: their geometric mean, the least and the largest over the scenes in which it reached the error. NaN if it
/// reached it in none.
///
/// Counted is a scene in which any of ours reaches the error and the reference resolves it.
results::Table ranking_table(const std::vector<SceneRuns>& scenes);

}  // namespace drape::bench
