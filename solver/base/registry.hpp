#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace drape::base {

/// The name that may have been meant: with the least edit distance, if that is at most 1 or a third of the length; else "".
std::string nearest_name(std::string_view name, std::span<const std::string_view> names);

/// One line on a name that is none of these.
std::string unknown_name(std::string_view kind, std::string_view name, std::span<const std::string_view> names);

/// The row of a table whose `name` this is. Throws std::invalid_argument, naming all that there are.
template <class Row>
const Row& find_named(std::span<const Row> table, std::string_view kind, std::string_view name) {
  const auto found = std::ranges::find(table, name, &Row::name);
  if (found != table.end()) return *found;
  std::vector<std::string_view> names;
  for (const Row& row : table) names.push_back(row.name);
  throw std::invalid_argument(unknown_name(kind, name, names));
}

}  // namespace drape::base
