#include "model/scene_file/obstacle_keys.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "model/scene_file/toml_text.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

constexpr std::string_view shapes[] = {"plane", "sphere", "box", "cylinder", "mesh"};
constexpr std::uintmax_t most_bytes = 256 << 20;  // of the file of a mesh
constexpr std::string_view frame_keys[] = {"time", "position", "rotation"};

/// The same file whatever folder the text is read from.
std::string absolute_path(const std::filesystem::path& file) { return std::filesystem::absolute(file).lexically_normal(); }

/// XXH3 of the bytes of a file.
std::string checksum(const std::string& file) {
  try {
    const std::string bytes = base::content_of(file, most_bytes);
    return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
  } catch (const base::UnreadableFile& error) {
    throw std::invalid_argument(fmt::format("{}: {}: expected the mesh of an obstacle", file, error.what()));
  }
}

void read_file(const Value& value, ObstacleRule& rule) {
  rule.file = absolute_path(value.folder() / value.text());
  try {
    base::require_input_file(rule.file, most_bytes);
  } catch (const base::UnreadableFile& error) {
    value.fail(fmt::format("the file of a mesh, {}: {}", base::quoted(rule.file), error.what()));
  }
}

void read_checksum(const Value& value, ObstacleRule& rule) {
  if (value.text() != checksum(rule.file)) value.fail(fmt::format("{}, that of {}", checksum(rule.file), rule.file));
}

KeyFrame read_frame(const Value& value) {
  KeyFrame frame;
  if (!value.table().contains("time")) value.fail("'time' in every key frame");
  for (const auto& [key, node] : value.table()) {
    const Value entry = value.child(key.str(), node);
    if (key == "time") {
      frame.t = entry.number();
    } else if (key == "position") {
      frame.position = entry.vector();
    } else if (key == "rotation") {
      frame.rotation = entry.vector();
    } else {
      entry.fail(fmt::format("no such key; a key frame has {}", fmt::join(frame_keys, ", ")));
    }
  }
  return frame;
}

void read_motion(const Value& value, ObstacleRule& rule) {
  rule.motion.clear();
  for (const Value& frame : value.list()) rule.motion.push_back(read_frame(frame));
  if (rule.motion.empty()) value.fail("at least one key frame");
  if (std::ranges::adjacent_find(rule.motion, std::ranges::greater_equal{}, &KeyFrame::t) != rule.motion.end())
    value.fail("key frames with times that ascend");
}

std::string written_frame(const KeyFrame& frame) {
  return fmt::format("{{ time = {}, position = {}, rotation = {} }}", frame.t, written(frame.position),
                     written(frame.rotation));
}

constexpr unsigned only(ShapeKind kind) { return 1u << static_cast<unsigned>(kind); }
constexpr unsigned any_shape = ~0u;

/// A key of obstacles: the shapes that have it, how it is read and how it is written, if it is.
struct ObstacleKey {
  std::string_view name;
  unsigned shapes;
  bool necessary;
  void (*read)(const Value&, ObstacleRule&);
  std::string (*write)(const ObstacleRule&);
};

/// In the order of reading and writing: the shape comes first, a file before its checksum.
constexpr ObstacleKey obstacle_keys[] = {
    {"shape", any_shape, true, [](const Value& v, ObstacleRule& o) { o.kind = static_cast<ShapeKind>(v.one_of(shapes)); },
     [](const ObstacleRule& o) { return written(shapes, o.kind); }},
    {"size", only(ShapeKind::box), true,
     [](const Value& v, ObstacleRule& o) {
       const std::vector<Value> lengths = v.list(3);
       o.size = {lengths[0].positive(), lengths[1].positive(), lengths[2].positive()};
     },
     [](const ObstacleRule& o) { return written(o.size); }},
    {"radius", only(ShapeKind::sphere) | only(ShapeKind::cylinder), true,
     [](const Value& v, ObstacleRule& o) { o.radius = v.positive(); },
     [](const ObstacleRule& o) { return fmt::format("{}", o.radius); }},
    {"height", only(ShapeKind::cylinder), true, [](const Value& v, ObstacleRule& o) { o.height = v.positive(); },
     [](const ObstacleRule& o) { return fmt::format("{}", o.height); }},
    {"file", only(ShapeKind::mesh), true, read_file, [](const ObstacleRule& o) { return in_quotes(absolute_path(o.file)); }},
    {"checksum", only(ShapeKind::mesh), false, read_checksum,
     [](const ObstacleRule& o) { return in_quotes(checksum(o.file)); }},
    {"scale", only(ShapeKind::mesh), false, [](const Value& v, ObstacleRule& o) { o.scale = v.positive(); },
     [](const ObstacleRule& o) { return fmt::format("{}", o.scale); }},
    {"friction", any_shape, false, [](const Value& v, ObstacleRule& o) { o.friction = v.non_negative(); },
     [](const ObstacleRule& o) { return fmt::format("{}", o.friction); }},
    {"position", any_shape, false, [](const Value& v, ObstacleRule& o) { o.motion.front().position = v.vector(); }, nullptr},
    {"rotation", any_shape, false, [](const Value& v, ObstacleRule& o) { o.motion.front().rotation = v.vector(); }, nullptr},
    {"motion", any_shape, false, read_motion, [](const ObstacleRule& o) { return written_list(o.motion, written_frame); }},
};

std::vector<ObstacleKey> keys_of(ShapeKind kind) {
  std::vector<ObstacleKey> keys;
  std::ranges::copy_if(obstacle_keys, std::back_inserter(keys),
                       [&](const ObstacleKey& key) { return (key.shapes & only(kind)) != 0; });
  return keys;
}

/// Every key belongs to the shape, none that is necessary is missing.
void check_keys(const Value& value, ShapeKind kind) {
  const std::string_view shape = shapes[static_cast<std::size_t>(kind)];
  const std::vector<ObstacleKey> keys = keys_of(kind);
  std::vector<std::string_view> names;
  for (const ObstacleKey& key : keys) names.push_back(key.name);
  for (const auto& [name, node] : value.table())
    if (std::ranges::find(names, name.str()) == names.end())
      value.child(name.str(), node).fail(fmt::format("no such key; a {} has {}", shape, fmt::join(names, ", ")));
  for (const ObstacleKey& key : keys)
    if (key.necessary && !value.table().contains(key.name)) value.fail(fmt::format("'{}' in every {}", key.name, shape));
  const auto has = [&](std::string_view name) { return value.table().contains(name); };
  if (has("motion") && (has("position") || has("rotation"))) value.fail("'motion' or 'position' and 'rotation', not both");
}

}  // namespace

ObstacleRule read_obstacle(const Value& value) {
  const toml::node* shape = value.table().get("shape");
  if (shape == nullptr) value.fail("'shape' in every obstacle");
  ObstacleRule rule;
  check_keys(value, static_cast<ShapeKind>(value.child("shape", *shape).one_of(shapes)));
  for (const ObstacleKey& key : obstacle_keys)
    if (const toml::node* node = value.table().get(key.name)) key.read(value.child(key.name, *node), rule);
  return rule;
}

std::string written(const ObstacleRule& rule) {
  std::vector<std::string> entries;
  for (const ObstacleKey& key : keys_of(rule.kind))
    if (key.write != nullptr) entries.push_back(fmt::format("{} = {}", key.name, key.write(rule)));
  return fmt::format("{{ {} }}", fmt::join(entries, ", "));
}

}  // namespace drape::model
