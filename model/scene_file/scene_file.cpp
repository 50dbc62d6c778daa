#include "model/scene_file/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>
#include <variant>

#include "model/garment.hpp"
#include "model/scene_file/keys.hpp"
#include "model/scene_file/outline_keys.hpp"
#include "model/scene_file/panel_keys.hpp"
#include "model/scene_file/toml_nesting.hpp"
#include "solver/base/input_file.hpp"
#include "solver/base/printable.hpp"
#include "solver/base/registry.hpp"

namespace drape::model {
namespace {

/// Origins of the keys that did not come from the file.
using Origins = std::map<std::string, std::string>;

/// Limits of files, so that no file takes long or much memory to be refused.
constexpr std::uintmax_t most_scene_bytes = 4 << 20;

toml::table parse(std::string_view text, std::string_view origin) {
  return parse_toml(
      text, origin,
      fmt::format("nested deeper than {} levels: expected a scene, whose keys have two parts and whose lists have at "
                  "most five levels",
                  most_toml_levels));
}

/// Puts the entries of a table into another one, tables into tables; anything else replaces what is there.
void merge(toml::table& from, toml::table& to) {
  for (auto&& [key, node] : from)
    if (toml::table* table = node.as_table(); table != nullptr && to.get_as<toml::table>(key) != nullptr)
      merge(*table, *to.get_as<toml::table>(key));
    else
      node.visit([&to, &name = key](auto& value) { to.insert_or_assign(name, std::move(value)); });  // a copy has no line
}

std::string text_of_scene(const std::string& name_or_file);

/// Replaces a scene that changes another, its `base`, by the whole.
void complete(toml::table& root, const std::string& file) {
  const toml::node* base = root.get("base");
  if (base == nullptr) return;
  const Value value(*base, "base", file);
  const std::string name = value.text();
  const bool is_file = name.ends_with(".toml");
  const std::string path = is_file ? value.input_file("a scene file", most_scene_bytes) : name;
  std::string text;
  try {
    text = text_of_scene(path);
  } catch (const SceneError& error) {
    value.fail(fmt::format("the name of a scene or a file: {}", error.what()));
  }
  toml::table whole = parse(text, path);
  if (whole.contains("base")) value.fail("a scene without a base of its own");
  parse_scene(text, path);  // what is wrong there is said of it
  root.erase("base");
  whole.erase("name");  // a file without one is called as it is
  merge(root, whole);
  root = std::move(whole);
}

/// The value of an override: TOML if it is TOML, else a bare word.
toml::table parse_value(const Override& change) {
  if (line_nested_deeper(change.value, most_toml_levels) > 0)
    throw SceneError(fmt::format("--set {}: nested deeper than {} levels", change.key, most_toml_levels));
  try {
    return toml::parse("value = " + change.value);
  } catch (const toml::parse_error&) {
    toml::table table;
    table.insert("value", change.value);
    return table;
  }
}

void apply(toml::table& root, const Override& change) {
  toml::table* table = &root;
  std::string_view rest = change.key;
  for (auto dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
    const std::string_view section = rest.substr(0, dot);
    if (!table->contains(section)) table->insert(section, toml::table{});
    table = table->get_as<toml::table>(section);
    if (table == nullptr) throw SceneError(fmt::format("--set {}: '{}' is not a section", change.key, section));
    rest.remove_prefix(dot + 1);
  }
  table->insert_or_assign(rest, *parse_value(change).get("value"));
}

/// All keys that stand in the file, as paths. Sections are opened, other tables are values.
void collect(const toml::table& table, const std::string& prefix, std::map<std::string, const toml::node*>& found) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    const bool section =
        std::ranges::any_of(scene_key_table(), [&](const SceneKey& known) { return known.name.starts_with(path + "."); });
    if (section && node.is_table() && (prefix.empty() || !node.as_table()->empty()))  // else a force without parameters
      collect(*node.as_table(), path + ".", found);
    else
      found.emplace(path, &node);
  }
}

/// `where`: the file and line of the key, or the override.
void check_known(const std::string& path, const std::string& where) {
  if (std::ranges::find(scene_key_table(), path, &SceneKey::name) != scene_key_table().end()) return;
  const std::string section = path.substr(0, path.find('.') + 1);
  std::vector<std::string_view> choices;
  for (const SceneKey& known : scene_key_table())
    if (section.empty() || known.name.starts_with(section)) choices.push_back(known.name);
  if (choices.empty())
    for (const SceneKey& known : scene_key_table()) choices.push_back(known.name);
  throw SceneError(fmt::format("{}: {}{}", where, base::unknown_name("key", path, choices),
                               section == "forces." ? ", or of a force that --plugin loads" : ""));
}

/// Rules that no single key of a sheet can break.
void check_sheet(const Scene& scene, const std::string& origin) {
  const Material& m = scene.sheet.material;
  const Grid& grid = scene.sheet.grid;
  const auto fail = [&](std::string_view what) { throw SceneError(fmt::format("{}: {}", origin, what)); };
  check_outline(grid, origin);
  if (!grid.uniform()) {
    if (m.shear_form != ShearForm::conservative)
      fail("material.shear_form: expected \"conservative\", the others are those of a rectangle with equal spacings");
    if (m.bend_form == BendForm::printed || m.bend_form == BendForm::printed_is_border)
      fail("material.bend_form: expected \"plate\" or \"membrane\", the others are those of a rectangle with equal spacings");
    if (grid.is_cut() && m.bend_form == BendForm::membrane)
      fail("material.bend_form: expected \"plate\", a membrane does not know the border of a cut");
    if (by_tables(m)) fail("material.law: expected \"linear\", tables are those of a rectangle with equal spacings");
    if (scene.start.pleats.count > 0) fail("start.pleats: expected 0 waves, they are those of a rectangle with equal spacings");
  }
  if (m.contraction * m.contraction >= m.tension.weft * m.tension.warp && m.contraction > 0)
    fail("material.contraction: expected C12² below k1 k2, or the material would collapse");
  if (m.shear_damping > 0 && m.shear_form > ShearForm::printed)
    fail("material.shear_damping: expected 0 beside a material.shear_form of the survey, which has no viscous part");
  const Relaxation& relaxation = m.relaxation;
  if ((relaxation.quality > 0) + !relaxation.maxwell.empty() + !relaxation.series.empty() > 1)
    fail("material.quality: expected one of quality, maxwell and series");
  if (relaxation.quality > 0 && relaxation.spectrum().empty())
    fail(fmt::format("material.quality: expected more than {:g} for so wide a band, or elements would have to feed energy",
                     relaxation.quality));
  if ((m.weft_curve.given() || m.warp_curve.given()) && !relaxation.spectrum().empty())
    fail("material.weft_curve: expected no quality, maxwell or series beside it, curves do not relax");
  if ((by_tables(m) || m.shear_curve.given()) && !relaxation.spectrum().empty())
    fail(fmt::format("material.{}: expected no quality, maxwell or series beside it, only moduli relax",
                     by_tables(m) ? "law" : "shear_curve"));
  if (by_tables(m) && (grid.nu < 2 || grid.nv < 2)) fail("material.law: expected \"linear\", a chain has no quadrants");
  if (scene.rest != RestShape::flat && (grid.nu < 2 || grid.nv < 2))
    fail("rest.shape: expected \"flat\", the curvature of a chain has no normal");
  const bool bends = m.bend.any() || m.bend_damping.any();
  if (bends && m.bend_form == BendForm::membrane && !m.bend_projected)
    fail("material.bend_projected = false: expected true, the membrane acts along the normal only");
  if (bends && m.bend_projected && (grid.nu < 2 || grid.nv < 2))
    fail("material.bend: expected bend_form = \"plate\" with bend_projected = false, a chain has no normals");
  if (scene.sheet.wind.needs_normals() && (grid.nu < 2 || grid.nv < 2))
    fail("forces.wind: expected forces.drag = forces.lift, a chain has no normals");
  if (scene.sheet.air != 0 && (grid.nu < 2 || grid.nv < 2)) fail("forces.air: expected 0, a chain has no normals");
  if (scene.start.wrap > 0 && (scene.start.plane != Plane::vertical || grid.nu < 2))
    fail("start.wrap: expected start.plane = \"vertical\" and at least 2 particles along the weft, or 0");
  for (const TermKind& kind : term_kinds_of(scene.sheet))
    if (!kind.parameters.empty()) try {
        make_term(kind, scene.sheet);
      } catch (const std::invalid_argument& error) {
        fail(error.what());
      }
}

void check_panels(const Scene& scene, const std::string& origin) {
  constexpr double most = 1e7;
  double particles = 0;
  for (const PanelRule& panel : scene.panels) {
    check_sheet(scene_of(panel, scene), fmt::format("{}: panel '{}'", origin, panel.name));
    particles += panel.grid.particles();
  }
  if (particles > most) throw SceneError(fmt::format("{}: panels: expected at most ten million particles", origin));
  if (scene.panels.empty() && !scene.seams.empty())
    throw SceneError(fmt::format("{}: seams: expected panels, which they join", origin));
  try {
    Garment{scene};
  } catch (const std::invalid_argument& error) {
    throw SceneError(fmt::format("{}: {}", origin, error.what()));
  }
}

/// Virtual particles are those of one sheet, whose tension is linear.
void check_adaptive(const Scene& scene, const Garment& garment, const std::string& origin) {
  const auto fail = [&](std::string_view what) { throw SceneError(fmt::format("{}: contact.adaptive: {}", origin, what)); };
  const auto& [nu, nv] = std::pair(scene.sheet.grid.nu, scene.sheet.grid.nv);
  if (!garment.is_one_sheet() || std::min(nu, nv) < 2) fail("expected a sheet, without panels");
  const Material& material = scene.sheet.material;
  const bool linear = !material.weft_curve.given() && !material.warp_curve.given() && !by_tables(material);
  if (!linear || !material.relaxation.spectrum().empty())
    fail("expected tension by the moduli alone, without curves, tables and relaxation");
}

/// Rules that no single key can break.
void check_together(const Scene& scene, const std::string& origin) {
  const auto fail = [&](std::string_view what) { throw SceneError(fmt::format("{}: {}", origin, what)); };
  if (scene.panels.empty()) check_sheet(scene, origin);
  check_panels(scene, origin);
  const Garment garment(scene);
  try {
    trimmed_surface(scene);
  } catch (const std::invalid_argument& error) {
    fail(fmt::format("trim: {}", error.what()));
  }
  constexpr double most_compared = 1e8;  // a second
  if (static_cast<double>(scene.pins.size()) * garment.particles() > most_compared)
    fail(fmt::format("pins: expected at most {:g} on a grid of {} particles, not {}",
                     std::floor(most_compared / garment.particles()), garment.particles(), scene.pins.size()));
  const std::vector<solver::Pin> all = pins(scene);
  if (std::ssize(all) == garment.nodes() && std::ranges::all_of(all, &solver::Pin::all))
    fail("pins: expected at least one coordinate that is free to move");
  if (scene.contact.adaptive) check_adaptive(scene, garment, origin);
}

/// The unit stands behind what the description begins with: "k1, k2 [N/m]: one number for both".
std::string with_unit(const KeyInfo& key) {
  std::string text(key.description);
  if (!key.unit.empty() && key.unit != "1") text.insert(std::min(text.find(':'), text.size()), fmt::format(" [{}]", key.unit));
  return text;
}

std::string read_file(const std::filesystem::path& path) {
  try {
    return base::content_of(path, most_scene_bytes);
  } catch (const base::UnreadableFile& error) {
    throw SceneError(fmt::format("{}: {}: expected a scene file of at most {}", path.string(), error.what(),
                                 base::in_megabytes(most_scene_bytes)));
  }
}

std::string text_of_scene(const std::string& name_or_file) {
  if (name_or_file.ends_with(".toml")) return read_file(name_or_file);
  if (name_or_file.ends_with(".obj") || name_or_file.ends_with(".json"))
    throw SceneError(
        fmt::format("{}: expected the name of a scene or a file ending in .toml, which bench_integrators pattern "
                    "makes of a garment mesh or a sewing pattern",
                    base::quoted(name_or_file)));
  try {
    return std::string(base::find_named(builtin_scenes(), "scene", name_or_file).toml);
  } catch (const std::invalid_argument& error) {
    throw SceneError(fmt::format("{}, or a file: a scene (.toml), a mesh (.obj, .ply) or a pattern (.json)", error.what()));
  }
}

}  // namespace

Override parse_override(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    throw SceneError(fmt::format("--set {}: expected key=value, for example material.damping=0.5", base::quoted(text)));
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Scene parse_scene(std::string_view toml, std::string_view origin, std::span<const Override> overrides) {
  const std::string file(origin);
  toml::table root = parse(toml, origin);
  complete(root, file);
  Origins origins;
  if (std::ranges::any_of(overrides, [](const Override& change) { return change.key == "material.fabric"; }))
    root.erase("material");  // the file's moduli would change the fabric's
  for (const Override& change : overrides) {
    origins[change.key] = "--set " + base::quoted(change.key);
    check_known(change.key, origins[change.key]);
    apply(root, change);
  }
  std::map<std::string, const toml::node*> found;
  collect(root, "", found);
  for (const auto& [path, node] : found) check_known(path, place(file, *node));

  Scene scene;
  for (const SceneKey& key : scene_key_table()) {
    const auto node = found.find(std::string(key.name));
    if (node == found.end()) continue;
    const auto changed = origins.find(node->first);
    key.read(Value(*node->second, node->first, changed == origins.end() ? file : changed->second), scene);
  }
  if (!found.contains("name")) scene.name = file.ends_with(".toml") ? std::filesystem::path(file).stem().string() : "";
  if (scene.name.empty()) throw SceneError(fmt::format("{}: name: expected a name for the scene", origin));
  check_together(scene, file);
  return scene;
}

Scene load_scene(const std::string& name_or_file, std::span<const Override> overrides) {
  return parse_scene(text_of_scene(name_or_file), name_or_file, overrides);
}

std::string to_toml(const Scene& scene) {
  std::string text;
  for (const SceneKey& key : scene_key_table())
    if (const Data data = key.data(scene); !std::holds_alternative<std::monostate>(data))
      text += fmt::format("{} = {}\n", key.name, to_toml(data));
  return text;
}

std::vector<KeyHelp> scene_keys() {
  std::vector<KeyHelp> keys;
  for (const SceneKey& key : scene_key_table()) keys.push_back({std::string(key.name), with_unit(key)});
  return keys;
}

std::vector<KeyValue> key_values(const Scene& scene) {
  std::vector<KeyValue> values;
  for (const SceneKey& key : scene_key_table()) {
    KeyValue row = key_value(key, scene);
    if (std::holds_alternative<std::monostate>(row.value)) continue;
    const auto* list = std::get_if<List>(&row.value);
    if (list == nullptr || (!list->empty() && !std::holds_alternative<Entries>(list->front())))
      values.push_back(std::move(row));
    else
      for (const Data& entry : *list) values.push_back({row.key, row.unit, row.description, entry});
  }
  return values;
}

std::vector<Override> without_trim(std::span<const Override> rows) {
  std::vector<Override> rest;
  for (const Override& row : rows) {
    if (row.key.starts_with("trim.")) continue;
    rest.push_back(row);
    if (row.key != "panels") continue;
    toml::table panel = *parse_value(row).get_as<toml::table>("value");
    panel.erase("trim");
    std::ostringstream text;
    text << toml::toml_formatter{panel, toml::format_flags::none};
    rest.back().value = text.str();
  }
  return rest;
}

Scene scene_of(std::span<const Override> rows, std::string_view origin) {
  std::string text;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::string &key = rows[k].key, &value = rows[k].value;
    const bool is_entry = value.starts_with('{');
    const auto beside = [&](std::size_t other) { return is_entry && other < rows.size() && rows[other].key == key; };
    text += k > 0 && beside(k - 1) ? ", " : fmt::format("{} = {}", key, is_entry ? "[" : "");
    text += value;
    if (!beside(k + 1)) text += is_entry ? "]\n" : "\n";
  }
  return parse_scene(text, origin);
}

}  // namespace drape::model
