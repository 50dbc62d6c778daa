#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "results/run_file.hpp"
#include "results/work_precision.hpp"

namespace drape::results {

/// The runs of all files by the name of their scene and what is set in it.
using RunsOfScene = std::map<std::string, std::vector<const RunRecord*>>;
RunsOfScene by_scene(std::span<const Recording> recordings);

bool ended_well(const RunRecord& run);

/// Times and error of a run, no smaller than its reference resolves; NaN where it has no error that can be compared.
Measured measured(const RunRecord& run);

/// Whether a contender in a table of work and precision is a solver of SUNDIALS.
bool is_sundials(std::string_view code);

}  // namespace drape::results
