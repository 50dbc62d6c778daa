#include "verify/support/obstacles.hpp"

#include <algorithm>

#include "model/scene_file/scene_file.hpp"

namespace drape::verify {

model::ObstacleRule obstacle(const std::string& entries) {
  return model::parse_scene("name = 'x'\nobstacles = [{" + entries + "}]\n", "obstacle").obstacles.front();
}

std::string value_of(const model::ObstacleRule& rule, const std::string& key) {
  const std::vector<model::KeyValue> values = model::key_values(rule);
  const auto found = std::ranges::find(values, key, &model::KeyValue::key);
  return found == values.end() ? "" : to_toml(found->value);
}

}  // namespace drape::verify
