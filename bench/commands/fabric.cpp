#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>

#include "bench/commands/commands.hpp"
#include "model/scene_file/arcsim_material.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

void convert(const std::string& file) {
  model::Scene scene;
  scene.sheet.material = model::read_arcsim_material(file);
  scene.sheet.material.law = model::StretchLaw::tables;
  fmt::print("# {}: the moduli are those of small strains, law = \"linear\" takes them throughout\n[material]\n",
             base::printable(file));
  for (const model::KeyValue& row : model::key_values(scene))
    for (const std::string_view key :
         {"density", "tension", "shear", "contraction", "bend", "stretch_table", "bend_table", "law"})
      if (row.key == fmt::format("material.{}", key)) fmt::print("{} = {}  # {}\n", key, to_toml(row.value), row.unit);
}

}  // namespace

void add_fabric(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("fabric", "a material file of ARCSim as keys of a scene file");
  const auto file = std::make_shared<std::string>();
  command.add_option("FILE.json", *file, "with density, stretching and bending")->required()->type_name("");
  command.callback([=] { convert(*file); });
}

}  // namespace drape::bench
