#pragma once

#include <string>
#include <vector>

#include "results/analysis/compare.hpp"

namespace drape::results {

/// What was seen in one cell of a comparison.
struct Difference {
  std::string cell;      ///< a run or a row of a table
  std::string quantity;  ///< for example "rms error"
  std::string a, b;      ///< its values
  double severity = 0;   ///< how bad it is; negative: an improvement. Only for the order in which differences are shown
  Change change = Change::same;
};

/// Differences of one kind in the order they were made.
struct Differences {
  std::vector<Difference> all;
  int cells = 0;  ///< that were looked at

  void add(Difference difference) { all.push_back(std::move(difference)); }
};

/// The worst of all changes, with counts as its reason, and the ten worst cells as a table of this name.
Aspect summary(const Differences& differences, const std::string& name);

/// Whether an error has grown from a to b by this factor and beyond the noise, or shrunk by it.
Change judge_error(double a, double b, double factor, double noise);

/// A number for users.
std::string shown(double value);

/// What tables of equal name say of accuracy and work.
void compare_tables(const std::vector<Table>& a, const std::vector<Table>& b, const CompareOptions& options,
                    Differences& accuracy, Differences& work);

}  // namespace drape::results
