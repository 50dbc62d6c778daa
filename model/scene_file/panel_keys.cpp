#include "model/scene_file/panel_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "model/garment.hpp"
#include "model/scene_file/keys.hpp"
#include "model/scene_file/pin_keys.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {
namespace {

constexpr std::array<std::string_view, 4> sections = {"grid", "material", "start", "trim"};

/// "grid.n" as its section and its name there.
std::pair<std::string_view, std::string_view> split(std::string_view key) {
  const auto dot = key.find('.');
  if (dot == std::string_view::npos) return {};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

bool is_of_panels(const SceneKey& key) { return std::ranges::find(sections, split(key.name).first) != sections.end(); }

void require_known(const Value& value) {
  for (const auto& [section, node] : value.table()) {
    if (section.str() == "name") continue;
    const Value child = value.child(section.str(), node);
    if (std::ranges::find(sections, section.str()) == sections.end())
      child.fail("no such key; a panel has name, and keys of the sections grid, material, start and trim");
    std::vector<KeyInfo> keys;
    for (const SceneKey& key : scene_key_table())
      if (const auto [of, name] = split(key.name); of == section.str()) keys.push_back({name, key.unit, key.description});
    require_keys(child, fmt::format("section {}", section.str()), keys);
  }
  if (!value.table().contains("name")) value.fail("'name' in every panel");
}

// --- Seams -------------------------------------------------------------------------------------------------------------------

void read_ends(const Value& value, SeamSide& side) {
  constexpr double most = 1e7;
  for (const Value& end : value.list(2)) {
    const double place = end.number();
    if (place < 0 || place > most || place != static_cast<int>(place)) end.fail("the place of a particle, from 0 on");
    side.ends.push_back(static_cast<int>(place));
  }
  if (side.ends[0] == side.ends[1]) value.fail("two places that differ");
}

Data ends_data(const SeamSide& side) {
  return side.ends.empty() ? Data() : Data(List{double(side.ends[0]), double(side.ends[1])});
}

constexpr Key<SeamSide> side_keys[] = {
    {"panel", "", "the name of a panel", at<&SeamSide::panel>, check::text, true},
    {"side", "", "\"lower\", \"right\", \"upper\" or \"left\"", at<&SeamSide::side>, check::one_of<panel_side_names>, true},
    {"ends", "", "[first, last] particle of the side, as the seam goes", read_ends, ends_data},
};

template <auto member>
void read_side(const Value& value, SeamRule& seam) {
  read_table<SeamSide>(value, "side of a seam", side_keys, seam.*member);
}

template <auto member>
Data side_data(const SeamRule& seam) {
  return entries_of<SeamSide>(side_keys, seam.*member);
}

constexpr Key<SeamRule> seam_keys[] = {
    {"one", "", "{ panel, side, ends }", read_side<&SeamRule::one>, side_data<&SeamRule::one>, true},
    {"other", "", "{ panel, side, ends }", read_side<&SeamRule::other>, side_data<&SeamRule::other>, true},
    {"ease", "1", "part by which one may be longer than the other", at<&SeamRule::ease>, check::non_negative},
};

// --- Phases ------------------------------------------------------------------------------------------------------------------

constexpr std::string_view seam_states[] = {"sewn", "pulled", "open"};

/// A phase with the scene whose particles its pins name.
struct PhaseOfScene {
  const Scene& scene;
  PhaseRule phase = {};
};

void read_gravity(const Value& value, PhaseOfScene& rule) { rule.phase.gravity = value.vector(&Value::number); }

Data gravity_data(const PhaseOfScene& rule) { return rule.phase.gravity ? to_data(*rule.phase.gravity) : Data(); }

void read_phase_pins(const Value& value, PhaseOfScene& rule) {
  std::vector<PinRule>& pins = rule.phase.pins.emplace();
  for (const Value& pin : value.list()) pins.push_back(read_pin(pin, rule.scene));
}

Data phase_pins_data(const PhaseOfScene& rule) {
  if (!rule.phase.pins) return {};
  List pins;
  for (const PinRule& pin : *rule.phase.pins) pins.emplace_back(entries_of(pin, rule.scene));
  return pins;
}

constexpr Key<PhaseOfScene> phase_keys[] = {
    {"until", "s", "its end", at<&PhaseOfScene::phase, &PhaseRule::until>, check::positive, true},
    {"gravity", "m/s²", "[x, y, z]", read_gravity, gravity_data},
    {"seams", "", "\"sewn\", \"pulled\" or \"open\"", at<&PhaseOfScene::phase, &PhaseRule::seams>, check::one_of<seam_states>},
    {"pins", "", "instead of those of the scene", read_phase_pins, phase_pins_data},
};

}  // namespace

Scene scene_of(const PanelRule& panel, const Scene& scene) {
  Scene own = scene;
  own.panels.clear();
  own.seams.clear();
  own.pins.clear();
  own.fabric = panel.fabric;
  own.sheet.grid = panel.grid;
  own.sheet.material = panel.material;
  own.start = panel.start;
  own.trim = panel.trim;
  return own;
}

PanelRule read_panel(const Value& value, const Scene& scene) {
  require_known(value);
  Scene own = scene;
  for (const SceneKey& key : scene_key_table()) {
    if (!is_of_panels(key)) continue;
    const auto [section, name] = split(key.name);
    const toml::node* node = value.table()[section][name].node();
    if (node != nullptr) key.read(value.child(key.name, *node), own);
  }
  const std::string name = value.child("name", *value.table().get("name")).title();
  if (name.empty()) value.fail("a name");
  if (std::ranges::find(scene.panels, name, &PanelRule::name) != scene.panels.end())
    value.fail(fmt::format("names that differ, '{}' is there twice", name));
  return {name, own.fabric, own.sheet.grid, own.sheet.material, own.start, own.trim};
}

Entries entries_of(const PanelRule& panel, const Scene& scene) {
  const Scene own = scene_of(panel, scene);
  Entries entries{{"name", panel.name}};
  for (const SceneKey& key : scene_key_table())
    if (is_of_panels(key)) entries.push_back({std::string(key.name), key.data(own)});
  return entries;
}

SeamRule read_seam(const Value& value) {
  SeamRule seam;
  read_table<SeamRule>(value, "seam", seam_keys, seam);
  return seam;
}

PhaseRule read_phase(const Value& value, const Scene& scene) {
  PhaseOfScene rule{scene};
  read_table<PhaseOfScene>(value, "phase", phase_keys, rule);
  if (!scene.phases.empty() && rule.phase.until <= scene.phases.back().until) value.fail("phases that end one after the other");
  return std::move(rule.phase);
}

Entries entries_of(const PhaseRule& phase, const Scene& scene) { return entries_of<PhaseOfScene>(phase_keys, {scene, phase}); }

Entries entries_of(const SeamRule& seam) { return entries_of<SeamRule>(seam_keys, seam); }

}  // namespace drape::model
