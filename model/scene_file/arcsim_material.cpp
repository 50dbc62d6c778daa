#include "model/scene_file/arcsim_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "model/fabric.hpp"
#include "model/keys/scene_error.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

class ArcsimMaterial {
 public:
  explicit ArcsimMaterial(const std::string& file)
      : file_(base::printable(file)), json_(nlohmann::json::parse(content(file), nullptr, false)) {
    if (!json_.is_object()) fail("expected a JSON object with density, stretching and bending");
  }

  Material material() const {
    const double density = number(member("density"), "density");
    if (!(density > 0)) fail("density: expected a number above 0");
    FabricTables tables;
    read("stretching", tables.stretching);
    read("bending", tables.bending);
    return material_of(density, tables);
  }

 private:
  static std::string content(const std::string& file) try {
    return base::content_of(file, most_arcsim_bytes);
  } catch (const base::UnreadableFile& error) {
    throw SceneError(fmt::format("{}: {}", base::printable(file), error.what()));
  }

  [[noreturn]] void fail(std::string_view what) const { throw SceneError(fmt::format("{}: {}", file_, what)); }

  const nlohmann::json& member(const char* key) const {
    if (!json_.contains(key)) fail(fmt::format("expected the key \"{}\"", key));
    return json_[key];
  }

  double number(const nlohmann::json& json, const char* key) const {
    if (!json.is_number() || !std::isfinite(json.get<double>())) fail(fmt::format("{}: expected finite numbers", key));
    return json.get<double>();
  }

  template <std::size_t rows, std::size_t columns>
  void read(const char* key, std::array<std::array<double, columns>, rows>& table) const {
    const nlohmann::json& json = member(key);
    const bool fits = json.is_array() && json.size() == rows && std::ranges::all_of(json, [](const nlohmann::json& row) {
                        return row.is_array() && row.size() == columns;
                      });
    if (!fits) fail(fmt::format("{}: expected {} rows of {} numbers", key, rows, columns));
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k) table[i][k] = number(json[i][k], key);
  }

  std::string file_;
  nlohmann::json json_;
};

}  // namespace

Material read_arcsim_material(const std::string& file) { return ArcsimMaterial(file).material(); }

}  // namespace drape::model
