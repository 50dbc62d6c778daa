#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/table.hpp"

namespace drape::verify {

/// A column whose title is its name. It is of text unless it has a unit.
inline results::Column column(const std::string& name, const std::string& unit, results::Role role,
                              std::vector<results::Datum> cells) {
  return {name, name, unit, "", role, std::move(cells), {}};
}

}  // namespace drape::verify
