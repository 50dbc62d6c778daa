#include "model/fabric.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <vector>

#include "model/builtin_fabrics.hpp"
#include "model/keys/value.hpp"

namespace drape::model {

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
  Fabric fabric{
      .name = std::string(name), .description = value("description").text(), .source = value("source").text(), .material = {}};
  const double density = value("density").positive();
  if (root.contains("stretching")) {
    fabric.material =
        material_of(density, {.stretching = value("stretching").numbers<6, 4>(), .bending = value("bending").numbers<3, 5>()});
    return fabric;
  }
  Material& m = fabric.material;
  m.density = density;
  m.tension = value("tension").weft_warp(&Value::positive);
  m.shear = value("shear").positive();
  m.bend = value("bend").weft_warp(&Value::positive);
  const WeftWarp hysteresis = value("bend_hysteresis").weft_warp(&Value::non_negative);
  m.friction.bend = {hysteresis.weft / 2, hysteresis.warp / 2};
  fabric.drape = value("drape").part();
  return fabric;
}

std::span<const Fabric> fabrics() {
  static const std::vector<Fabric> all = [] {
    std::vector<Fabric> read;
    for (const auto& [name, toml] : builtin_fabrics()) read.push_back(read_fabric(toml, name, name));
    return read;
  }();
  return all;
}

Material material_of(double density, const FabricTables& tables) {
  const auto twice = [&](int column) { return std::max(0.0, 2 * tables.stretching[0][column]); };
  Material material;
  material.tables = tables;
  material.density = density;
  material.tension = {twice(0), twice(2)};
  material.contraction = twice(1);
  material.shear = twice(3) / 4;
  material.bend = {std::max(0.0, tables.bending[0][0]), std::max(0.0, tables.bending[2][0])};
  return material;
}

}  // namespace drape::model
