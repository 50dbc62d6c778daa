#pragma once

#include <span>
#include <vector>

#include "results/file/run_file.hpp"

namespace drape::results {

/// What some files come to, as a few short tables; those without rows are left out.
/// - `conclusion`: all of it in words
/// - every headline table of the files, whole
/// - `orders`: of every curve whether its order is as declared
/// - `quickest-runs`: of each scene the quickest recorded runs with errors <= 1e-1, 1e-2, …
/// - `failures`: runs that failed, how, and how far they came
/// - `not-met`: what else has a verdict that begins with NOT, at most ten
std::vector<Table> overview(std::span<const Recording> recordings);

}  // namespace drape::results
