#include "model/keys/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "solver/base/input_file.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {

std::string place(const std::string& origin, const toml::node& node) {
  const auto line = node.source().begin.line;
  return origin.starts_with("--") || line == 0 ? origin : fmt::format("{}:{}", origin, line);
}

std::string Value::shown() const {
  std::ostringstream out;
  node_.visit([&](const auto& value) { out << value; });
  std::string text = out.str();
  std::ranges::replace(text, '\n', ' ');  // of the layout of lists
  return base::quoted(text);
}

void Value::fail(const std::string& what_is_right) const {
  throw SceneError(fmt::format("{}: {} = {}: expected {}", place(origin_, node_), key_, shown(), what_is_right));
}

std::string Value::text() const {
  if (const auto value = node_.value<std::string_view>(); value && node_.is_string()) return std::string(*value);
  fail("a text in quotes");
}

std::string Value::title() const {
  constexpr std::size_t most = 200;
  std::string title = text();
  if (base::characters(title) > most) fail(fmt::format("a name of at most {} characters", most));
  return title;
}

bool Value::flag() const {
  if (node_.is_boolean()) return *node_.value<bool>();
  fail("true or false");
}

double Value::number() const {
  if (!node_.is_number()) fail("a number");
  const double value = *node_.value<double>();
  if (!std::isfinite(value)) fail("a finite number");
  return value;
}

double Value::positive() const {
  const double value = number();
  if (value <= 0) fail("a number above 0");
  return value;
}

double Value::non_negative() const {
  const double value = number();
  if (value < 0) fail("a number of at least 0");
  return value;
}

double Value::part() const {
  const double value = positive();
  if (value > 1) fail("a number above 0 and at most 1");
  return value;
}

double Value::part_or_none() const {
  const double value = number();
  if (!(value >= 0 && value <= 1)) fail("a number from 0 to 1");
  return value;
}

double Value::up_to_two() const {
  const double value = positive();
  if (value > 2) fail("a number above 0 and at most 2");
  return value;
}

int Value::count() const {
  constexpr std::int64_t most = 10'000'000;
  const auto value = node_.is_integer() ? node_.value<std::int64_t>() : std::nullopt;
  if (!value || *value < 1 || *value > most) fail(fmt::format("a whole number from 1 to {}", most));
  return static_cast<int>(*value);
}

std::vector<Value> Value::list() const {
  const toml::array* array = node_.as_array();
  if (array == nullptr) fail("a list in brackets");
  std::vector<Value> values;
  for (const toml::node& element : *array) values.emplace_back(element, key_, origin_);
  return values;
}

std::vector<Value> Value::list(std::size_t size) const {
  if (!node_.is_array() || node_.as_array()->size() != size) fail(fmt::format("a list of {} numbers", size));
  return list();
}

const toml::table& Value::table() const {
  if (!node_.is_table()) fail("a table");
  return *node_.as_table();
}

std::string Value::input_file(std::string_view what, std::uintmax_t most_bytes) const {
  namespace fs = std::filesystem;
  const fs::path folder = origin_.ends_with(".toml") ? fs::path(origin_).parent_path() : fs::path();
  std::string file = fs::absolute(folder / text()).lexically_normal();
  try {
    base::require_input_file(file, most_bytes);
  } catch (const base::UnreadableFile& error) {
    fail(fmt::format("{}, {}: {}", what, base::quoted(file), error.what()));
  }
  return file;
}

WeftWarp Value::weft_warp(double (Value::*one)() const) const {
  if (!node_.is_array()) return {(this->*one)(), (this->*one)()};
  const std::vector<Value> values = list(2);
  return {(values[0].*one)(), (values[1].*one)()};
}

Eigen::Vector3d Value::vector(double (Value::*one)() const) const {
  const std::vector<Value> values = list(3);
  return {(values[0].*one)(), (values[1].*one)(), (values[2].*one)()};
}

std::size_t Value::one_of(std::span<const std::string_view> names) const {
  const std::string given = node_.is_string() ? text() : "";
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == given) return k;
  const std::string nearest = base::nearest_name(given, names);
  fail(fmt::format("one of \"{}\"{}", fmt::join(names, "\", \""),
                   nearest.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", nearest)));
}

}  // namespace drape::model
