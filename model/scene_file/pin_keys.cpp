#include "model/scene_file/pin_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "model/keys/key.hpp"

namespace drape::model {
namespace {

/// A pin with the scene whose particles it names.
struct PinOfScene {
  const Scene& scene;
  PinRule pin = {};

  const Grid& grid() const { return pinned_grid(scene, pin); }
};

void read_pinned_panel(const Value& value, PinOfScene& rule) {
  std::vector<std::string_view> names;
  for (const PanelRule& panel : rule.scene.panels) names.push_back(panel.name);
  if (names.empty()) value.fail("no panel, the scene has one sheet");
  rule.pin.panel = names[value.one_of(names)];
}

Data pinned_panel_data(const PinOfScene& rule) { return rule.pin.panel.empty() ? Data() : rule.pin.panel; }

void read_where(const Value& value, PinOfScene& rule) {
  const std::vector<std::string_view> names(pin_places().begin(), pin_places().end());
  rule.pin.where = names[value.one_of(names)];
}

Data where_data(const PinOfScene& rule) { return rule.pin.where.empty() ? Data() : rule.pin.where; }

void read_particles(const Value& value, PinOfScene& rule) {
  const Grid& grid = rule.grid();
  for (const Value& pair : value.list()) {
    const std::vector<Value> ab = pair.list(2);
    const double a = ab[0].number(), b = ab[1].number();
    if (a < 0 || b < 0 || a >= grid.nu || b >= grid.nv || a != static_cast<int>(a) || b != static_cast<int>(b))
      value.fail(fmt::format("places [a, b] with 0 ≤ a < {} and 0 ≤ b < {}", grid.nu, grid.nv));
    rule.pin.particles.emplace_back(static_cast<int>(a), static_cast<int>(b));
  }
}

Data particles_data(const PinOfScene& rule) {
  List pairs;
  for (const auto& [a, b] : rule.pin.particles) pairs.emplace_back(List{double(a), double(b)});
  return rule.pin.particles.empty() ? Data() : Data(pairs);
}

void read_circle(const Value& value, PinOfScene& rule) {
  rule.pin.circle = value.vector(&Value::number);
  if (!(rule.pin.circle[2] > 0)) value.fail("[x, y, radius] with a radius > 0");
  if (pinned_particles(rule.grid(), rule.pin).empty()) value.fail("a circle with particles of the grid inside");
}

Data circle_data(const PinOfScene& rule) {
  const Eigen::Vector3d& circle = rule.pin.circle;
  return circle[2] > 0 ? Data(List{circle[0], circle[1], circle[2]}) : Data();
}

void read_directions(const Value& value, PinOfScene& rule) {
  const std::string text = value.text();
  rule.pin.directions = {};
  for (const char c : text) {
    if (c < 'x' || c > 'z' || rule.pin.directions[c - 'x']) value.fail("some of the letters x, y and z");
    rule.pin.directions[c - 'x'] = true;
  }
  if (text.empty()) value.fail("some of the letters x, y and z");
}

Data directions_data(const PinOfScene& rule) {
  if (rule.pin.oblique()) return {};
  std::string text;
  for (int c = 0; c < 3; ++c)
    if (rule.pin.directions[c]) text += static_cast<char>('x' + c);
  return text;
}

void read_direction(const Value& value, PinOfScene& rule) {
  rule.pin.direction = value.vector(&Value::number);
  if (!rule.pin.oblique()) value.fail("[x, y, z], not all of them 0");
}

Data direction_data(const PinOfScene& rule) {
  const Eigen::Vector3d& d = rule.pin.direction;
  return rule.pin.oblique() ? Data(List{d[0], d[1], d[2]}) : Data();
}

constexpr Key<PathPoint> path_keys[] = {
    {"time", "s", "when", at<&PathPoint::t>, check::number, true},
    {"position", "m", "[x, y, z] from the start", at<&PathPoint::position>, check::number, true},
};

void read_path(const Value& value, PinOfScene& rule) {
  for (const Value& point : value.list())
    read_table<PathPoint>(point, "point of a path", path_keys, rule.pin.path.emplace_back());
  constexpr std::size_t most = 1000;
  if (rule.pin.path.empty() || rule.pin.path.size() > most) value.fail(fmt::format("1 to {} points", most));
  if (std::ranges::adjacent_find(rule.pin.path, std::ranges::greater_equal{}, &PathPoint::t) != rule.pin.path.end())
    value.fail("points with times that ascend");
  if (!rule.pin.velocity.isZero(0)) value.fail("a velocity or a path, not both");
}

Data path_data(const PinOfScene& rule) {
  List points;
  for (const PathPoint& point : rule.pin.path) points.emplace_back(entries_of<PathPoint>(path_keys, point));
  return points.empty() ? Data() : Data(points);
}

constexpr Key<PinOfScene> pin_keys[] = {
    {"panel", "", "the name of a panel", read_pinned_panel, pinned_panel_data},
    {"where", "", "the name of a place", read_where, where_data},
    {"particles", "", "[a, b] along u and v", read_particles, particles_data},
    {"circle", "m", "[x, y, radius] on the pattern: all particles inside", read_circle, circle_data},
    {"directions", "", "letters of x, y and z", read_directions, directions_data},
    {"direction", "", "instead of these a single one, [x, y, z] of any length", read_direction, direction_data},
    {"velocity", "m/s", "[x, y, z]", at<&PinOfScene::pin, &PinRule::velocity>, check::number},
    {"path", "", "instead of a velocity, points { time, position } between which it moves uniformly", read_path, path_data},
};

}  // namespace

PinRule read_pin(const Value& value, const Scene& scene) {
  PinOfScene rule{scene};
  if (!scene.panels.empty() && !value.table().contains("panel")) value.fail("'panel' in every pin of a scene with panels");
  if (value.table().contains("direction") && value.table().contains("directions"))
    value.fail("'direction' or 'directions' in a pin, not both");
  read_table<PinOfScene>(value, "pin", pin_keys, rule);
  if (!rule.pin.where.empty() + !rule.pin.particles.empty() + (rule.pin.circle[2] > 0) != 1)
    value.fail("one of 'where', 'particles' and 'circle' in every pin");
  return std::move(rule.pin);
}

Entries entries_of(const PinRule& pin, const Scene& scene) { return entries_of<PinOfScene>(pin_keys, {scene, pin}); }

}  // namespace drape::model
