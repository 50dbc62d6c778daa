#include "model/fabric.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "bench/commands/commands.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::bench {
namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t most_fabric_bytes = 1 << 20;

/// A material file of ARCSim.
class ArcsimMaterial {
 public:
  explicit ArcsimMaterial(const std::string& file) : file_(file), json_(Json::parse(content(file), nullptr, false)) {
    if (!json_.is_object()) fail("expected a JSON object with density, stretching and bending");
  }

  model::Material material() const {
    const double density = number(member("density"), "density");
    if (!(density > 0)) fail("density: expected a number above 0");
    model::FabricTables tables;
    read("stretching", tables.stretching);
    read("bending", tables.bending);
    return model::material_of(density, tables);
  }

 private:
  static std::string content(const std::string& file) try {
    return base::content_of(file, most_fabric_bytes);
  } catch (const base::UnreadableFile& error) {
    throw std::invalid_argument(fmt::format("{}: {}", base::printable(file), error.what()));
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw std::invalid_argument(fmt::format("{}: {}", base::printable(file_), what));
  }

  const Json& member(const char* key) const {
    if (!json_.contains(key)) fail(fmt::format("expected the key \"{}\"", key));
    return json_[key];
  }

  double number(const Json& json, const char* key) const {
    if (!json.is_number() || !std::isfinite(json.get<double>())) fail(fmt::format("{}: expected finite numbers", key));
    return json.get<double>();
  }

  template <std::size_t rows, std::size_t columns>
  void read(const char* key, std::array<std::array<double, columns>, rows>& table) const {
    const Json& json = member(key);
    const bool fits = json.is_array() && json.size() == rows &&
                      std::ranges::all_of(json, [](const Json& row) { return row.is_array() && row.size() == columns; });
    if (!fits) fail(fmt::format("{}: expected {} rows of {} numbers", key, rows, columns));
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k) table[i][k] = number(json[i][k], key);
  }

  std::string file_;
  Json json_;
};

void convert(const std::string& file) {
  model::Scene scene;
  scene.sheet.material = ArcsimMaterial(file).material();
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
