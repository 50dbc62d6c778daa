#pragma once

#include <span>
#include <string_view>

namespace drape::model {

/// A file of model/fabrics/.
struct BuiltinFabric {
  std::string_view name, toml;
};

std::span<const BuiltinFabric> builtin_fabrics();

}  // namespace drape::model
