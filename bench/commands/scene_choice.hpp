#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "model/scene.hpp"

namespace drape::bench {

/// A scene on the command line: its name or file, also one of a mesh or a sewing pattern, and keys that are set differently.
struct SceneChoice {
  std::string scene;
  std::vector<std::string> sets;

  /// Throws model::SceneError or std::invalid_argument, naming the file, line or key.
  model::Scene load() const;
};

/// The option --scene, where there has to be one.
void add_scene_option(CLI::App& command, SceneChoice& choice);

/// The option --set.
void add_overrides(CLI::App& command, SceneChoice& choice);

}  // namespace drape::bench
