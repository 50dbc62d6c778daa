#pragma once

#include "model/keys/data.hpp"
#include "model/keys/value.hpp"
#include "model/scene.hpp"

namespace drape::model {

/// A pin of a scene file that holds particles of a grid. Throws SceneError.
PinRule read_pin(const Value& value, const Grid& grid);

/// Its entries.
Entries entries_of(const PinRule& pin, const Grid& grid);

}  // namespace drape::model
