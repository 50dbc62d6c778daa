#pragma once

#include <string>
#include <vector>

#include "results/analysis/compare.hpp"

namespace drape::results {

/// What was seen in one cell of a comparison.
struct Finding {
  std::string cell;      ///< a run or a row of a table
  std::string quantity;  ///< for example "rms error"
  std::string a, b;      ///< its values
  double change = 0;     ///< how bad it is; negative: an improvement. Only for the order in which findings are shown
  Judgement judgement = Judgement::same;
};

/// Findings of one kind in the order they were made.
struct Findings {
  std::vector<Finding> all;
  int cells = 0;  ///< that were looked at

  void add(Finding finding) { all.push_back(std::move(finding)); }
};

/// The worst of all judgements, with counts as its reason, and the ten worst cells as a table of this name.
Judged summary(const Findings& findings, const std::string& name);

/// Whether an error has grown from a to b by this factor and beyond the noise, or shrunk by it.
Judgement judge_error(double a, double b, double factor, double noise);

/// A number for users.
std::string shown(double value);

/// What tables of equal name say of accuracy and work.
void compare_tables(const std::vector<Table>& a, const std::vector<Table>& b, const CompareOptions& options, Findings& accuracy,
                    Findings& work);

}  // namespace drape::results
