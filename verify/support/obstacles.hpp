#pragma once

#include <string>

#include "model/obstacles/obstacle.hpp"

namespace drape::verify {

/// An obstacle by the entries of its table: "shape = 'sphere', radius = 2".
model::ObstacleRule obstacle(const std::string& entries);

/// What a key of it holds, as TOML; "" if it has no such key.
std::string value_of(const model::ObstacleRule& rule, const std::string& key);

}  // namespace drape::verify
