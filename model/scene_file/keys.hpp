#pragma once

#include <span>
#include <string>

#include "model/keys/key.hpp"
#include "model/scene.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::model {

using SceneKey = Key<Scene>;

/// All keys of scene files in the order in which they are read and written. The table is the only place that knows a key.
std::span<const SceneKey> scene_key_table();

template <class Record>
KeyValue key_value(const Key<Record>& key, const Record& record) {
  return {std::string(key.name), std::string(key.unit_in(record)), std::string(key.description), key.data(record)};
}

}  // namespace drape::model
