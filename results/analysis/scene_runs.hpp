#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "results/analysis/work_precision.hpp"
#include "results/file/run_file.hpp"

namespace drape::results {

/// The runs of all files by the name of their scene and what is set in it.
using RunsOfScene = std::map<std::string, std::vector<const RunRecord*>>;
RunsOfScene by_scene(std::span<const Recording> recordings);

/// Times and error of a run, no smaller than its reference resolves; NaN where it has no error that can be compared.
Measured measured(const RunRecord& run);

/// Curves of a table of orders, and those whose order is as declared.
struct OrderCount {
  int curves = 0, as_declared = 0;
};
OrderCount count_orders(const Table& table);

}  // namespace drape::results
