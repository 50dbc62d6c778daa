#pragma once

#include <string>

#include "model/keys/data.hpp"
#include "model/keys/value.hpp"
#include "model/obstacles/obstacle.hpp"

namespace drape::model {

/// An obstacle of a scene file. Throws SceneError.
ObstacleRule read_obstacle(const Value& value);

/// Its entries, among them the checksum of its mesh's file. Throws std::invalid_argument if that cannot be read.
Entries entries_of(const ObstacleRule& rule);

/// The keys of obstacles, shape by shape, for help.
std::string obstacle_help();

}  // namespace drape::model
