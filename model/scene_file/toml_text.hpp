#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/sheet/sheet.hpp"

namespace drape::model {

/// Values as TOML. Read again they are the same, to the last bit and character.
std::string in_quotes(std::string_view text);
std::string written(const WeftWarp& m);
std::string written(const Eigen::Vector3d& a);

/// A word for an enumeration's value; `names` are in the order of the values.
template <class Enum>
std::string written(std::span<const std::string_view> names, Enum value) {
  return in_quotes(names[static_cast<std::size_t>(value)]);
}

/// A list of values, each written by `one`.
template <class Entry>
std::string written_list(const std::vector<Entry>& entries, std::string (*one)(const Entry&)) {
  std::string text = "[";
  for (const Entry& entry : entries) text += (text.size() > 1 ? ", " : "") + one(entry);
  return text + "]";
}

}  // namespace drape::model
