#include "model/keys/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace drape::model {

void require_keys(const Value& table, std::string_view what, const std::vector<KeyInfo>& keys) {
  for (const auto& [name, node] : table.table()) {
    if (std::ranges::find(keys, name.str(), &KeyInfo::name) != keys.end()) continue;
    std::vector<std::string_view> names;
    for (const KeyInfo& key : keys) names.push_back(key.name);
    table.child(name.str(), node).fail(fmt::format("no such key; a {} has {}", what, fmt::join(names, ", ")));
  }
  for (const KeyInfo& key : keys)
    if (key.necessary && !table.table().contains(key.name)) table.fail(fmt::format("'{}' in every {}", key.name, what));
}

}  // namespace drape::model
