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

/// Curves of a table of orders, those whose order is as declared, and the names and verdicts of the others, those first that
/// miss theirs.
struct OrderCount {
  int curves = 0, as_declared = 0;
  std::vector<std::string> others;
};
OrderCount count_orders(const Table& table);

/// The keys of a row that users see; of a curve those that are texts, for all of its rows.
std::string row_title(const Table& table, std::size_t row, bool of_curve = false);

}  // namespace drape::results
