#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/sheet/sheet.hpp"

namespace drape::model {

struct Data;
struct Entry;
using List = std::vector<Data>;
using Entries = std::vector<Entry>;  ///< a table

/// What a key of a scene holds, whatever it is written as. Empty: the key is left out.
struct Data : std::variant<std::monostate, bool, double, std::string, List, Entries> {
  using variant::variant;
};

struct Entry {
  std::string key;
  Data value;
};

Data to_data(const WeftWarp& m);
Data to_data(const Eigen::Vector3d& a);

/// As TOML. Read again it is the same, to the last bit and character.
std::string to_toml(const Data& data);

}  // namespace drape::model
