#pragma once

#include "model/scene_file/toml_value.hpp"

namespace drape::model {

/// A key of scene files: how it is read and how it is written. The table is the only place that knows a key.
struct SceneKey {
  std::string_view path;  ///< "section.key"
  std::string_view description;
  void (*read)(const Value&, Scene&);
  std::string (*write)(const Scene&);  ///< as TOML
};

/// All keys in the order in which they are read and written.
std::span<const SceneKey> scene_key_table();

}  // namespace drape::model
