#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "bench/cell.hpp"

namespace drape::bench {

/// A study: a fixed list of runs with a question. A row of the table, its cells in a file of its own under bench/studies/.
struct Study {
  std::string_view name;
  std::string_view description;
  std::vector<Group> (*groups)(bool quick);  ///< quick: a short form for tests
};

/// All studies; the first is the main job.
std::span<const Study> studies();

/// The study with this name. Throws std::invalid_argument, naming all that there are.
const Study& study(std::string_view name);

std::vector<Group> hung_sheets(bool quick);

}  // namespace drape::bench
