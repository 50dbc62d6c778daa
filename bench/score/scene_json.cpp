#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>

#include "bench/score/export.hpp"
#include "bench/score/observables.hpp"
#include "model/forces/term.hpp"
#include "model/scene_file/scene_file.hpp"

namespace drape::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Values of keys as JSON has them.
struct ToJson {
  Json operator()(std::monostate) const { return {}; }
  Json operator()(const model::List& list) const {
    Json all = Json::array();
    for (const model::Data& value : list) all.push_back(std::visit(*this, value));
    return all;
  }
  Json operator()(const model::Entries& table) const {
    Json all = Json::object();
    for (const auto& [key, value] : table) all[key] = std::visit(*this, value);
    return all;
  }
  Json operator()(const auto& value) const { return value; }
};

Json to_json(const model::Data& value) { return std::visit(ToJson(), value); }

/// All keys of a section.
Json section(const std::string& name, const model::Scene& scene) {
  Json all = Json::object();
  for (const model::KeyValue& key : model::key_values(scene)) {
    if (!key.key.starts_with(name + ".")) continue;
    Json entry{{"value", to_json(key.value)}};
    if (!key.unit.empty()) entry["unit"] = key.unit;
    entry["meaning"] = key.description;
    all[key.key.substr(name.size() + 1)] = entry;
  }
  return all;
}

Json list(const Eigen::Vector3d& a) { return {a[0], a[1], a[2]}; }

Json rows(const solver::Vectors& vectors) {
  Json all = Json::array();
  for (Eigen::Index i = 0; i < vectors.rows(); ++i) all.push_back(list(vectors.row(i)));
  return all;
}

Json particles(const model::Scene& scene, const model::Cloth& cloth) {
  const model::Grid& grid = scene.sheet.grid;
  const auto spacing = [&](double equal) { return grid.uniform() ? Json(equal) : Json(); };
  return {{"count", grid.particles()},
          {"nu", grid.nu},
          {"nv", grid.nv},
          {"index", "particle (a, b) is a + nu b, counted from 0; a along u, the weft, b along v, the warp"},
          {"side_u", grid.size_u},
          {"side_v", grid.size_v},
          {"spacing_u", spacing(grid.spacing_u())},  // null if they differ
          {"spacing_v", spacing(grid.spacing_v())},
          {"pattern", grid.uniform() ? Json() : rows(grid.parameters())},
          {"mass_rule",
           !grid.uniform() ? "lumped: density times a quarter of the cloth in each cell around the particle"
           : grid.border_cells == model::BorderCells::dual
               ? "lumped: density times the area of the dual cell; half of an inner one on borders, a quarter in corners"
               : "lumped: density times spacing_u spacing_v, also on borders"},
          {"mass", std::vector<double>(cloth.ode.mass.begin(), cloth.ode.mass.end())}};
}

Json pins(const model::Cloth& cloth, std::span<const double> times) {
  Json all = Json::array();
  for (const solver::Pin& pin : cloth.ode.pins) {
    Json entry{
        {"particle", pin.particle}, {"fixed", {pin.fixed(0), pin.fixed(1), pin.fixed(2)}}, {"velocity", list(pin.velocity)}};
    if (!pin.velocity.isZero(0)) {
      entry["positions"] = Json::array();  // at the times of the frames; null in free directions
      for (const double t : times) {
        Json position = Json::array();
        for (int c = 0; c < 3; ++c)
          position.push_back(pin.fixed(c) ? Json(cloth.start.x(pin.particle, c) + t * pin.velocity[c]) : Json());
        entry["positions"].push_back(position);
      }
    }
    all.push_back(entry);
  }
  return all;
}

/// Shape and numbers: what else there is of it, as the file of a mesh, is in obstacle-k.obj, its motion in itself in
/// obstacle-k-n.obj.
Json shape(const model::ObstacleRule& rule) {
  Json entry{{"shape", rule.kind->name}, {"meaning", rule.kind->description}};
  for (const model::KeyValue& key : model::key_values(rule))
    if (!key.unit.empty()) entry[key.key] = to_json(key.value);
  return entry;
}

Json obstacles(const model::Scene& scene) {
  Json all = Json::array();
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const model::ObstacleRule& rule = scene.obstacles[k];
    Json entry = shape(rule);
    entry["file"] = fmt::format("obstacle-{}.obj", k);
    entry["friction"] = rule.friction;
    for (const model::KeyFrame& frame : rule.motion)
      entry["key_frames"].push_back(
          {{"time", frame.t}, {"position", list(frame.position)}, {"rotation", list(frame.rotation)}});
    all.push_back(entry);
  }
  return all;
}

Json equations(const model::Cloth& cloth) {
  Json all{{"source", "O. Etzmuß, Animation of Surfaces with Applications to Cloth Modelling, Tübingen 2002"},
           {"motion", "(3.20): M dv/dt = K x + D v + f(t, x, v), dx/dt = v, with lumped masses"},
           {"forces", Json::object()}};
  for (const model::TermKind& kind : model::term_kinds())
    if (std::ranges::count(cloth.plan.terms, kind.name) > 0) all["forces"][std::string(kind.name)] = kind.description;
  if (cloth.contacts)
    all["contact"] =
        "4.1 and 4.2 (penalty, field, reposition, reflect, impulse, alteration), 4.3 (reaction) and 4.4 (constraint)";
  return all;
}

Json expected(const TrueMotion& truth, std::span<const double> times) {
  Json all = Json::array();
  const auto observed = observe(truth, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Observables &value = observed[k].value, &unsure = observed[k].uncertainty;
    const auto pair = [](double v, double u) { return Json{{"value", v}, {"uncertainty", u}}; };
    all.push_back({{"time", times[k]},
                   {"kinetic_energy", pair(value.kinetic, unsure.kinetic)},
                   {"potential_energy", pair(value.potential, unsure.potential)},
                   {"total_energy", pair(value.total, unsure.total)},
                   {"centre_of_mass", {{"value", list(value.centre)}, {"uncertainty", observed[k].centre_distance}}},
                   {"lowest_point", pair(value.lowest, unsure.lowest)},
                   {"largest_stretch", pair(value.stretch, unsure.stretch)},
                   {"position_uncertainty", uncertainty_at(truth, times[k])}});
  }
  return all;
}

}  // namespace

std::string scene_json(const TrueMotion& truth, std::span<const double> times) {
  const model::Scene& scene = truth.scene;
  Json all{{"name", scene.name},
           {"description", scene.description},
           {"units",
            {{"length", "m"},
             {"time", "s"},
             {"mass", "kg"},
             {"force", "N"},
             {"energy", "J"},
             {"rotation", "axis times degrees"},
             {"stretch", "1"}}},
           {"particles", particles(scene, truth.cloth)},
           {"material", section("material", scene)},
           {"forces", section("forces", scene)},
           {"equations", equations(truth.cloth)},
           {"pins", pins(truth.cloth, times)},
           {"obstacles", obstacles(scene)}};
  if (truth.cloth.contacts) all["contact"] = section("contact", scene);
  all["start"] = {{"positions", rows(truth.motion.states.front().x)}, {"velocities", rows(truth.motion.states.front().v)}};
  all["end_time"] = scene.end;
  all["frame_times"] = times;
  all["reference"] = {{"file", "reference.h5"}, {"families", truth.families}, {"growth_of_perturbations", truth.growth}};
  all["expected"] = expected(truth, times);
  return all.dump(1) + "\n";
}

}  // namespace drape::bench
