#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/keys/data.hpp"
#include "model/keys/scene_error.hpp"
#include "model/scene.hpp"

namespace drape::model {

/// One override of a key: "material.damping" = "0.5".
struct Override {
  std::string key;
  std::string value;  ///< TOML; a bare word counts as a string
};

/// Splits "key=value". Throws SceneError.
Override parse_override(std::string_view text);

/// Reads scene text. `origin` names it in messages. With `base`, the name or file of another scene, the text changes that: keys
/// replace its keys, lists its lists. Throws SceneError.
Scene parse_scene(std::string_view toml, std::string_view origin, std::span<const Override> overrides = {});

/// A built-in scene by name, or a file whose name ends in .toml; without a key `name` it is called as the file is. Throws
/// SceneError.
Scene load_scene(const std::string& name_or_file, std::span<const Override> overrides = {});

/// The complete scene as TOML, defaults included: parse_scene gives the same scene back.
std::string to_toml(const Scene& scene);

/// A built-in scene: a file of model/scenes/ compiled in.
struct BuiltinScene {
  std::string_view name;
  std::string_view toml;
};
std::span<const BuiltinScene> builtin_scenes();

/// A key of scene files, for help.
struct KeyHelp {
  std::string path;
  std::string description;  ///< with its unit
};
std::vector<KeyHelp> scene_keys();

/// What a key holds.
struct KeyValue {
  std::string key;
  std::string unit;  ///< "1": a number without dimension; empty: not a number
  std::string description;
  Data value;
};

/// All keys of a scene. A list of tables, as that of its pins, has a row for each of its entries.
std::vector<KeyValue> key_values(const Scene& scene);

/// Those of an obstacle except its shape.
std::vector<KeyValue> key_values(const ObstacleRule& rule);

/// Rows of a scene without what only draws it, and whose files may be gone.
std::vector<Override> without_trim(std::span<const Override> rows);

/// The scene with such rows, their values as TOML. `origin` names it in messages. Throws SceneError.
Scene scene_of(std::span<const Override> rows, std::string_view origin);

}  // namespace drape::model
