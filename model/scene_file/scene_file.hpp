#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "model/scene.hpp"

namespace drape::model {

/// A scene that cannot be read: one sentence with the file, line, key and what would be right.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One override of a key: "material.damping" = "0.5".
struct Override {
  std::string key;
  std::string value;  ///< TOML; a bare word counts as a string
};

/// Splits "key=value". Throws SceneError.
Override parse_override(std::string_view text);

/// Reads scene text. `origin` names it in messages. Throws SceneError.
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
  std::string description;
};
std::vector<KeyHelp> scene_keys();

/// The values that all keys have in a scene, as TOML, by their paths.
std::map<std::string, std::string> key_values(const Scene& scene);

}  // namespace drape::model
