#include "model/scene_file/obstacle_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>
#include <vector>

#include "model/scene_file/keys.hpp"

namespace drape::model {
namespace {

constexpr Key<KeyFrame> frame_keys[] = {
    {"time", "s", "when", at<&KeyFrame::t>, check::number, true},
    {"position", "m", "[x, y, z]", at<&KeyFrame::position>, check::number},
    {"rotation", "degrees", "axis times angle", at<&KeyFrame::rotation>, check::number},
};

void read_motion(const Value& value, ObstacleRule& rule) {
  rule.motion.clear();
  for (const Value& frame : value.list()) read_table<KeyFrame>(frame, "key frame", frame_keys, rule.motion.emplace_back());
  if (rule.motion.empty()) value.fail("at least one key frame");
  if (std::ranges::adjacent_find(rule.motion, std::ranges::greater_equal{}, &KeyFrame::t) != rule.motion.end())
    value.fail("key frames with times that ascend");
}

Data motion_data(const ObstacleRule& rule) {
  List frames;
  for (const KeyFrame& frame : rule.motion) frames.emplace_back(entries_of<KeyFrame>(frame_keys, frame));
  return frames;
}

/// What `motion` says as well.
Data not_written(const ObstacleRule& /*rule*/) { return {}; }

/// The keys of every obstacle.
constexpr Key<ObstacleRule> common_keys[] = {
    {"friction", "1", "Coulomb's coefficient", at<&ObstacleRule::friction>, check::non_negative},
    {"position", "m", "[x, y, z] of an obstacle at rest",
     [](const Value& value, ObstacleRule& rule) { rule.motion.front().position = value.vector(&Value::number); }, not_written},
    {"rotation", "degrees", "axis times angle of an obstacle at rest",
     [](const Value& value, ObstacleRule& rule) { rule.motion.front().rotation = value.vector(&Value::number); }, not_written},
    {"motion", "", "key frames", read_motion, motion_data},
};

constexpr KeyInfo shape_key{"shape", "", "what it is", true};

void read_shape(const Value& value, ObstacleRule& rule) {
  std::vector<std::string_view> names;
  for (const ShapeKind* kind : shape_kinds()) names.push_back(kind->name);
  rule.kind = shape_kinds()[value.one_of(names)];
}

/// Every key belongs to the shape, none that is necessary is missing.
void check_keys(const Value& value, const ShapeKind& kind) {
  std::vector<KeyInfo> keys{shape_key};
  std::ranges::copy(kind.keys(), std::back_inserter(keys));
  std::ranges::copy(common_keys, std::back_inserter(keys));
  require_keys(value, kind.name, keys);
  const auto has = [&](std::string_view name) { return value.table().contains(name); };
  if (has("motion") && (has("position") || has("rotation"))) value.fail("'motion' or 'position' and 'rotation', not both");
}

}  // namespace

ObstacleRule read_obstacle(const Value& value) {
  const toml::node* shape_name = value.table().get(shape_key.name);
  if (shape_name == nullptr) value.fail("'shape' in every obstacle");
  ObstacleRule rule;
  read_shape(value.child(shape_key.name, *shape_name), rule);
  check_keys(value, *rule.kind);
  const std::shared_ptr<ShapeRule> shape = rule.kind->create();
  read_entries(value, rule.kind->keys(), *shape);
  rule.shape = shape;
  read_entries<ObstacleRule>(value, common_keys, rule);
  return rule;
}

Entries entries_of(const ObstacleRule& rule) {
  Entries entries{{std::string(shape_key.name), std::string(rule.kind->name)}};
  std::ranges::move(entries_of(rule.kind->keys(), *rule.shape), std::back_inserter(entries));
  std::ranges::move(entries_of<ObstacleRule>(common_keys, rule), std::back_inserter(entries));
  return entries;
}

std::vector<KeyValue> key_values(const ObstacleRule& rule) {
  std::vector<KeyValue> values;
  for (const Key<ShapeRule>& key : rule.kind->keys()) values.push_back(key_value(key, *rule.shape));
  for (const Key<ObstacleRule>& key : common_keys) values.push_back(key_value(key, rule));
  std::erase_if(values, [](const KeyValue& key) { return std::holds_alternative<std::monostate>(key.value); });
  return values;
}

std::string obstacle_help() {
  std::vector<std::string> shapes;
  for (const ShapeKind* kind : shape_kinds()) {
    std::string& shape = shapes.emplace_back(kind->name);
    for (const KeyInfo& key : kind->keys()) shape.append(", ").append(key.name);
  }
  return fmt::format(
      "list of {{ shape = {}; friction, position, rotation | motion = [{{ time, position, rotation }}, ...] }}: a rotation is "
      "an axis times degrees; between two key frames an obstacle turns the shorter way, by less than half a turn",
      fmt::join(shapes, " | "));
}

}  // namespace drape::model
