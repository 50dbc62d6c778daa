#include "bench/commands/scene_choice.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "bench/runs/available_memory.hpp"
#include "bench/runs/verbosity.hpp"
#include "model/adaptive/sheet_refinement.hpp"
#include "model/at_rest.hpp"
#include "model/clear_cloth.hpp"
#include "model/clear_start.hpp"
#include "model/pattern/sewn_pattern.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {

namespace {

/// A mesh or a sewing pattern becomes the scene that the command `pattern` prints.
model::Scene load_pattern(const std::string& file, const std::vector<model::Override>& overrides) {
  const std::string text = model::to_toml(model::sew(model::read_pattern(file), model::usual_spacing));
  model::Scene loaded = model::parse_scene(text, file, overrides);
  say_note(fmt::format("{}: {}; to change more than keys: bench/run pattern {} >my.toml", file, loaded.description, file));
  return loaded;
}

}  // namespace

model::Scene SceneChoice::load() const {
  std::vector<model::Override> overrides;
  for (const std::string& text : sets) overrides.push_back(model::parse_override(text));
  model::Scene loaded = model::is_pattern(scene) ? load_pattern(scene, overrides) : model::load_scene(scene, overrides);
  require_memory(loaded);
  try {
    model::require_bodies(loaded);
    model::require_clear_start(loaded);
    model::require_clear_cloth(loaded);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", scene, error.what()));
  }
  if (model::is_at_rest(loaded)) say_note(fmt::format("in the scene {} {}", loaded.name, model::at_rest_remark));
  return loaded;
}

void add_scene_option(CLI::App& command, SceneChoice& choice) {
  command
      .add_option("--scene", choice.scene,
                  "built-in scene, or a file: a scene (.toml), a mesh (.obj, .ply) or a pattern (.json)")
      ->required()
      ->type_name("NAME|FILE");
}

void add_overrides(CLI::App& command, SceneChoice& choice) {
  command.add_option("--set", choice.sets, "override a key of the scene (repeatable)")
      ->type_name("key=value")
      ->allow_extra_args(false);
}

}  // namespace drape::bench
