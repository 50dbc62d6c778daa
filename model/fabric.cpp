#include "model/fabric.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <vector>

#include "model/builtin_fabrics.hpp"
#include "model/keys/value.hpp"

namespace drape::model {

namespace {

template <std::size_t rows, std::size_t columns>
std::array<std::array<double, columns>, rows> table(const Value& value) {
  std::array<std::array<double, columns>, rows> all{};
  const std::vector<Value> lines = value.list(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::vector<Value> numbers = lines[i].list(columns);
    for (std::size_t k = 0; k < columns; ++k) all[i][k] = numbers[k].number();
  }
  return all;
}

}  // namespace

Fabric read_fabric(std::string_view toml, std::string_view name, std::string_view origin) {
  toml::table root;
  try {
    root = toml::parse(toml, origin);
  } catch (const toml::parse_error& error) {
    throw SceneError(std::string(origin) + ": " + std::string(error.description()));
  }
  const auto value = [&](std::string_view key) {
    const toml::node* const node = root.get(key);
    if (node == nullptr) throw SceneError(std::string(origin) + ": expected the key '" + std::string(key) + "'");
    return Value(*node, std::string(key), std::string(origin));
  };
  return {.name = std::string(name),
          .description = value("description").text(),
          .source = value("source").text(),
          .density = value("density").positive(),
          .stretching = table<6, 4>(value("stretching")),
          .bending = table<3, 5>(value("bending"))};
}

std::span<const Fabric> fabrics() {
  static const std::vector<Fabric> all = [] {
    std::vector<Fabric> read;
    for (const auto& [name, toml] : builtin_fabrics()) read.push_back(read_fabric(toml, name, name));
    return read;
  }();
  return all;
}

Material material_of(const Fabric& fabric) {
  const auto twice = [&](int column) { return std::max(0.0, 2 * fabric.stretching[0][column]); };
  Material material;
  material.density = fabric.density;
  material.tension = {twice(0), twice(2)};
  material.contraction = twice(1);
  material.shear = twice(3) / 4;
  material.bend = {std::max(0.0, fabric.bending[0][0]), std::max(0.0, fabric.bending[2][0])};
  return material;
}

}  // namespace drape::model
