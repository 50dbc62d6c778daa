#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drape::bench {

/// The names of those for which something holds, for a message.
template <class Row, class Holds>
std::string names_of(std::span<const Row> table, Holds holds) {
  std::vector<std::string_view> names;
  for (const Row& row : table)
    if (holds(row)) names.push_back(row.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace drape::bench
