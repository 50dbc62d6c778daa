#include "model/scene_file/keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/scene_file/obstacle_keys.hpp"
#include "model/scene_file/toml_text.hpp"
#include "solver/base/printable.hpp"

namespace drape::model {
namespace {

constexpr std::string_view damping_forms[] = {"linear", "projected"};
constexpr std::string_view shear_forms[] = {"conservative", "printed"};
constexpr std::string_view bend_forms[] = {"membrane", "plate", "printed"};
constexpr std::string_view border_cells[] = {"dual", "whole"};
constexpr std::string_view planes[] = {"horizontal", "vertical"};
constexpr std::string_view responses[] = {"constraint", "reaction"};
constexpr std::string_view pin_keys[] = {"where", "particles", "directions", "velocity"};

std::array<bool, 3> read_directions(const Value& value) {
  const std::string text = value.text();
  std::array<bool, 3> directions{};
  for (const char c : text) {
    if (c < 'x' || c > 'z' || directions[c - 'x']) value.fail("some of the letters x, y and z");
    directions[c - 'x'] = true;
  }
  if (text.empty()) value.fail("some of the letters x, y and z");
  return directions;
}

void read_particles(const Value& value, const Grid& grid, PinRule& rule) {
  for (const Value& pair : value.list()) {
    const std::vector<Value> ab = pair.list(2);
    const double a = ab[0].number(), b = ab[1].number();
    if (a < 0 || b < 0 || a >= grid.nu || b >= grid.nv || a != static_cast<int>(a) || b != static_cast<int>(b))
      value.fail(fmt::format("places [a, b] with 0 ≤ a < {} and 0 ≤ b < {}", grid.nu, grid.nv));
    rule.particles.emplace_back(static_cast<int>(a), static_cast<int>(b));
  }
}

/// Of pins and of obstacles: each is compared with all particles.
std::vector<Value> rules(const Value& value) {
  constexpr std::size_t most = 1000;
  std::vector<Value> all = value.list();
  if (all.size() > most) value.fail(fmt::format("at most {} entries, not {}", most, all.size()));
  return all;
}

PinRule read_pin(const Value& value, const Grid& grid) {
  PinRule rule;
  for (const auto& [key, node] : value.table()) {
    const Value entry = value.child(key.str(), node);
    if (key == "where") {
      const std::vector<std::string_view> names(pin_places().begin(), pin_places().end());
      rule.where = names[entry.one_of(names)];
    } else if (key == "particles") {
      read_particles(entry, grid, rule);
    } else if (key == "directions") {
      rule.directions = read_directions(entry);
    } else if (key == "velocity") {
      rule.velocity = entry.vector();
    } else {
      entry.fail(fmt::format("no such key; a pin has {}", fmt::join(pin_keys, ", ")));
    }
  }
  if (rule.where.empty() == rule.particles.empty()) value.fail("either 'where' or 'particles' in every pin");
  return rule;
}

std::string written_pin(const PinRule& rule) {
  std::string directions;
  for (int c = 0; c < 3; ++c)
    if (rule.directions[c]) directions += static_cast<char>('x' + c);
  std::string place = "where = " + in_quotes(rule.where);
  if (rule.where.empty()) {
    place = "particles = [";
    for (const auto& [a, b] : rule.particles) place += fmt::format("[{}, {}], ", a, b);
    place += "]";
  }
  return fmt::format("{{ {}, directions = \"{}\", velocity = {} }}", place, directions, written(rule.velocity));
}

void read_name(const Value& value, Scene& scene) {
  constexpr std::size_t most = 200;
  scene.name = value.text();
  if (base::characters(scene.name) > most) value.fail(fmt::format("a name of at most {} characters", most));
}

void read_grid_n(const Value& value, Scene& scene) {
  Grid& grid = scene.sheet.grid;
  if (value.is_list()) {
    const std::vector<Value> n = value.list(2);
    grid.nu = n[0].count();
    grid.nv = n[1].count();
  } else {
    grid.nu = grid.nv = value.count();
  }
  constexpr double most = 1e7;
  if (grid.nu * static_cast<double>(grid.nv) < 2) value.fail("at least 2 particles");
  if (grid.nu * static_cast<double>(grid.nv) > most) value.fail("at most ten million particles");
}

void read_pleats(const Value& value, Scene& scene) {
  const std::vector<Value> parts = value.list(2);
  const double count = parts[0].non_negative(), degrees = parts[1].non_negative();
  const int most = (scene.sheet.grid.nu - 1) / 2;
  if (count > most || count != static_cast<int>(count) || degrees >= 90)
    value.fail(fmt::format("a whole number of at most {} waves, for two edges each, and an angle below 90 degrees", most));
  scene.start.pleats = {static_cast<int>(count), degrees};
}

void read_relaxation(const Value& value, Scene& scene) {
  scene.contact.relaxation = value.positive();
  if (scene.contact.relaxation > 1) value.fail("a number above 0 and at most 1");
}

constexpr SceneKey all_keys[] = {
    {"name", "what tables and files call the scene [the file's name without .toml]", read_name,
     [](const Scene& s) { return in_quotes(s.name); }},
    {"description", "one sentence", [](const Value& v, Scene& s) { s.description = v.text(); },
     [](const Scene& s) { return in_quotes(s.description); }},

    {"grid.n", "particles along weft and warp: one number or [nu, nv]; 1 makes a chain", read_grid_n,
     [](const Scene& s) { return fmt::format("[{}, {}]", s.sheet.grid.nu, s.sheet.grid.nv); }},
    {"grid.size", "sides along weft and warp [m]: one number or two; of a chain also the width it stands for",
     [](const Value& v, Scene& s) {
       const WeftWarp size = v.weft_warp(&Value::positive);
       s.sheet.grid.size_u = size.weft;
       s.sheet.grid.size_v = size.warp;
     },
     [](const Scene& s) {
       return written(WeftWarp{s.sheet.grid.size_u, s.sheet.grid.size_v});
     }},

    {"grid.border_cells", "\"dual\" (half on borders) or \"whole\" (as the algorithms of the thesis print it)",
     [](const Value& v, Scene& s) { s.sheet.grid.border_cells = static_cast<BorderCells>(v.one_of(border_cells)); },
     [](const Scene& s) { return written(border_cells, s.sheet.grid.border_cells); }},

    {"material.density", "ρ [kg/m²]", [](const Value& v, Scene& s) { s.sheet.material.density = v.positive(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.material.density); }},
    {"material.tension", "k1, k2 [N/m]: one number for both, or [weft, warp]",
     [](const Value& v, Scene& s) { s.sheet.material.tension = v.weft_warp(&Value::non_negative); },
     [](const Scene& s) { return written(s.sheet.material.tension); }},
    {"material.damping", "d1, d2 [N s/m]: viscous tension, one number for both, or [weft, warp]",
     [](const Value& v, Scene& s) { s.sheet.material.damping = v.weft_warp(&Value::non_negative); },
     [](const Scene& s) { return written(s.sheet.material.damping); }},
    {"material.damping_form", "\"linear\" (treated implicitly, also damps transversally) or \"projected\"",
     [](const Value& v, Scene& s) { s.sheet.material.damping_form = static_cast<DampingForm>(v.one_of(damping_forms)); },
     [](const Scene& s) { return written(damping_forms, s.sheet.material.damping_form); }},
    {"material.shear", "G [N/m]", [](const Value& v, Scene& s) { s.sheet.material.shear = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.material.shear); }},
    {"material.shear_damping", "dG [N s/m]",
     [](const Value& v, Scene& s) { s.sheet.material.shear_damping = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.material.shear_damping); }},
    {"material.shear_form", "\"conservative\" or \"printed\" (Algorithm 2 of the thesis)",
     [](const Value& v, Scene& s) { s.sheet.material.shear_form = static_cast<ShearForm>(v.one_of(shear_forms)); },
     [](const Scene& s) { return written(shear_forms, s.sheet.material.shear_form); }},
    {"material.contraction", "C12 [N/m]: transverse contraction, with C12² below k1 k2",
     [](const Value& v, Scene& s) { s.sheet.material.contraction = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.material.contraction); }},
    {"material.contraction_damping", "d12 [N s/m]",
     [](const Value& v, Scene& s) { s.sheet.material.contraction_damping = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.material.contraction_damping); }},
    {"material.bend", "B1, B2 [N m] (plate) or [N/m] (membrane): one number for both, or [weft, warp]",
     [](const Value& v, Scene& s) { s.sheet.material.bend = v.weft_warp(&Value::non_negative); },
     [](const Scene& s) { return written(s.sheet.material.bend); }},
    {"material.bend_damping", "viscous counterparts of B1, B2",
     [](const Value& v, Scene& s) { s.sheet.material.bend_damping = v.weft_warp(&Value::non_negative); },
     [](const Scene& s) { return written(s.sheet.material.bend_damping); }},
    {"material.bend_form", "\"plate\" (fourth order), \"membrane\" (second order) or \"printed\" (Algorithm 4 of the thesis)",
     [](const Value& v, Scene& s) { s.sheet.material.bend_form = static_cast<BendForm>(v.one_of(bend_forms)); },
     [](const Scene& s) { return written(bend_forms, s.sheet.material.bend_form); }},
    {"material.bend_projected", "plate only: forces along the vertex normal (as the thesis) or, if false, in all directions",
     [](const Value& v, Scene& s) { s.sheet.material.bend_projected = v.flag(); },
     [](const Scene& s) { return std::string(s.sheet.material.bend_projected ? "true" : "false"); }},

    {"forces.gravity", "[x, y, z] in m/s²", [](const Value& v, Scene& s) { s.sheet.gravity = v.vector(); },
     [](const Scene& s) { return written(s.sheet.gravity); }},
    {"forces.wind", "w: [x, y, z] in N/m²; the wind is (a + sin ωt) w",
     [](const Value& v, Scene& s) { s.sheet.wind.load = v.vector(); },
     [](const Scene& s) { return written(s.sheet.wind.load); }},
    {"forces.wind_constant", "a: the steady part of the wind",
     [](const Value& v, Scene& s) { s.sheet.wind.constant = v.number(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.wind.constant); }},
    {"forces.wind_frequency", "ω [rad/s]; 0: a steady wind",
     [](const Value& v, Scene& s) { s.sheet.wind.frequency = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.wind.frequency); }},
    {"forces.drag", "c_drag: part of the wind that acts along the normals",
     [](const Value& v, Scene& s) { s.sheet.wind.drag = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.wind.drag); }},
    {"forces.lift", "c_lift: part of the wind that acts across the normals",
     [](const Value& v, Scene& s) { s.sheet.wind.lift = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.wind.lift); }},
    {"forces.air", "c_w ρ_air [N s/m³]: resistance of the air to motion across the sheet",
     [](const Value& v, Scene& s) { s.sheet.air = v.non_negative(); },
     [](const Scene& s) { return fmt::format("{}", s.sheet.air); }},

    {"pins", "list of { where | particles, directions, velocity }: prescribed motion",
     [](const Value& v, Scene& s) {
       for (const Value& pin : rules(v)) s.pins.push_back(read_pin(pin, s.sheet.grid));
     },
     [](const Scene& s) { return written_list(s.pins, written_pin); }},

    {"obstacles",
     "list of { shape = plane | sphere | box | cylinder | mesh, size | radius | height | file | scale, friction, position, "
     "rotation | motion = [{ time, position, rotation }, ...] }: a rotation is an axis times degrees; between two key frames "
     "an obstacle turns the shorter way, by less than half a turn",
     [](const Value& v, Scene& s) {
       for (const Value& obstacle : rules(v)) s.obstacles.push_back(read_obstacle(obstacle));
     },
     [](const Scene& s) { return written_list<ObstacleRule>(s.obstacles, written); }},
    {"contact.distance", "d [m]: what is nearer to an obstacle than this is in its collision area",
     [](const Value& v, Scene& s) { s.contact.distance = v.positive(); },
     [](const Scene& s) { return fmt::format("{}", s.contact.distance); }},
    {"contact.relaxation", "ω: part of its depth in the collision area that a particle loses in a step", read_relaxation,
     [](const Scene& s) { return fmt::format("{}", s.contact.relaxation); }},
    {"contact.response",
     "\"constraint\" (of velocities in the linear systems) or \"reaction\" (damped springs instead of forces)",
     [](const Value& v, Scene& s) { s.contact.response = static_cast<ResponseKind>(v.one_of(responses)); },
     [](const Scene& s) { return written(responses, s.contact.response); }},
    {"contact.reaction_time", "τ [s]: the springs of reactions have k = m/τ² and d = 2m/τ",
     [](const Value& v, Scene& s) { s.contact.reaction_time = v.positive(); },
     [](const Scene& s) { return fmt::format("{}", s.contact.reaction_time); }},

    {"start.plane", "\"horizontal\" (v along y) or \"vertical\" (v along z)",
     [](const Value& v, Scene& s) { s.start.plane = static_cast<Plane>(v.one_of(planes)); },
     [](const Scene& s) { return written(planes, s.start.plane); }},
    {"start.stretch", "factors along weft and warp at t = 0",
     [](const Value& v, Scene& s) { s.start.stretch = v.weft_warp(&Value::positive); },
     [](const Scene& s) { return written(s.start.stretch); }},
    {"start.pleats", "[count, degrees]: waves along the weft without strain, and how steep they are at t = 0", read_pleats,
     [](const Scene& s) { return fmt::format("[{}, {}]", s.start.pleats.count, s.start.pleats.degrees); }},
    {"start.velocity", "[x, y, z] in m/s of all particles at t = 0",
     [](const Value& v, Scene& s) { s.start.velocity = v.vector(); }, [](const Scene& s) { return written(s.start.velocity); }},

    {"end.time", "simulated time [s]", [](const Value& v, Scene& s) { s.end = v.positive(); },
     [](const Scene& s) { return fmt::format("{}", s.end); }},
};

}  // namespace

std::span<const SceneKey> scene_key_table() { return all_keys; }

}  // namespace drape::model
