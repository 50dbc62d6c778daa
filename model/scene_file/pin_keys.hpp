#pragma once

#include "model/keys/data.hpp"
#include "model/keys/value.hpp"
#include "model/scene.hpp"

namespace drape::model {

/// A pin of a scene file that holds particles of a grid. Throws SceneError.
PinRule read_pin(const Value& value, const Scene& scene);

/// Its entries.
Entries entries_of(const PinRule& pin, const Scene& scene);

}  // namespace drape::model
