#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "model/keys/key.hpp"
#include "model/scene.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::model {

/// A key of scenes: a row of ours, or a parameter of a force that was added.
struct SceneKey : KeyInfo {
  explicit SceneKey(const Key<Scene>& row) : KeyInfo(row), unit_of(row.unit_of), read(row.read), data(row.data) {}
  SceneKey(const KeyInfo& info, std::function<void(const Value&, Scene&)> own_read, std::function<Data(const Scene&)> own_data)
      : KeyInfo(info), read(std::move(own_read)), data(std::move(own_data)) {}

  std::string_view unit_in(const Scene& scene) const { return unit_of == nullptr ? unit : unit_of(scene); }

  std::string_view (*unit_of)(const Scene&) = nullptr;
  std::function<void(const Value&, Scene&)> read;
  std::function<Data(const Scene&)> data;  ///< gives none if the scene does without the key
};

/// All keys of scene files in the order in which they are read and written. The table is the only place that knows a key.
std::span<const SceneKey> scene_key_table();

/// Adds a row for as long as the program runs; what it points to must stay. To be called before scenes are read.
void add_scene_key(SceneKey key);

template <class AnyKey, class Record>
KeyValue key_value(const AnyKey& key, const Record& record) {
  return {std::string(key.name), std::string(key.unit_in(record)), std::string(key.description), key.data(record)};
}

}  // namespace drape::model
