#include "bench/commands/scene_choice.hpp"

#include "bench/available_memory.hpp"
#include "model/scene_file.hpp"

namespace drape::bench {

model::Scene SceneChoice::load() const {
  std::vector<model::Override> overrides;
  for (const std::string& text : sets) overrides.push_back(model::parse_override(text));
  model::Scene loaded = model::load_scene(scene, overrides);
  require_memory(loaded);
  return loaded;
}

void add_overrides(CLI::App& command, SceneChoice& choice) {
  command.add_option("--set", choice.sets, "override a key of the scene (repeatable)")
      ->type_name("key=value")
      ->allow_extra_args(false);
}

}  // namespace drape::bench
