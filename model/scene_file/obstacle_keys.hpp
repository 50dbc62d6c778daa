#pragma once

#include <string>

#include "model/scene_file/toml_value.hpp"

namespace drape::model {

/// An obstacle of a scene file. Throws SceneError.
ObstacleRule read_obstacle(const Value& value);

/// An obstacle as TOML, with the checksum of its mesh's file. Throws std::invalid_argument if that cannot be read.
std::string written(const ObstacleRule& rule);

}  // namespace drape::model
