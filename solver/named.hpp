#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace drape::solver {

/// The row of a table whose `name` this is. Throws std::invalid_argument, naming all that there are.
template <class Row>
const Row& find_named(std::span<const Row> table, std::string_view kind, std::string_view name) {
  const auto found = std::ranges::find(table, name, &Row::name);
  if (found != table.end()) return *found;
  std::string message("unknown ");
  message.append(kind).append(" '").append(name).append("': expected one of");
  const char* separator = " ";
  for (const Row& row : table) {
    message.append(separator).append(row.name);
    separator = ", ";
  }
  throw std::invalid_argument(message);
}

}  // namespace drape::solver
