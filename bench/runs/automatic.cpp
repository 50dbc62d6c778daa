#include "bench/runs/automatic.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/runs/choice_rule.hpp"
#include "model/phases.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/stability.hpp"

namespace drape::bench {
namespace {

/// The scene without all that the rule does not know.
model::Scene as_known(const model::Scene& scene) {
  model::Scene known;
  known.name = scene.name, known.description = scene.description, known.fabric = scene.fabric;
  const auto& [nu, nv, size_u, size_v, borders, outline, grading_u, grading_v, cut] = scene.sheet.grid;
  known.sheet.grid = {.nu = nu, .nv = nv, .size_u = size_u, .size_v = size_v, .border_cells = borders};
  const model::Material& material = scene.sheet.material;
  known.sheet.material.density = material.density;
  known.sheet.material.tension = {material.tension.weft, material.tension.weft};
  known.sheet.material.damping = {material.damping.weft, material.damping.weft};
  constexpr double most_shear = 0.05;  // of the tension
  if (material.shear <= most_shear * material.tension.weft) known.sheet.material.shear = material.shear;
  known.sheet.gravity = scene.sheet.gravity;
  known.pins = scene.pins;
  for (model::PinRule& pin : known.pins) pin.velocity.setZero(), pin.path.clear();
  known.start.plane = scene.start.plane, known.start.position = scene.start.position;
  known.contact = scene.contact, known.trim = scene.trim, known.end = scene.end;
  return known;
}

bool same(const model::KeyValue& a, const model::KeyValue& b) {
  return a.key == b.key && model::to_toml(a.value) == model::to_toml(b.value);
}

/// The keys of a scene that the rule does not know, or what else is in its way; empty if it knows the scene.
std::string unknown_in(const model::Scene& scene) {
  std::vector<std::string> keys;
  if (!scene.panels.empty()) return "panels";
  const auto has = model::key_values(scene), known = model::key_values(as_known(scene));
  for (const model::KeyValue& row : has)
    if (std::ranges::none_of(known, [&](const model::KeyValue& other) { return same(row, other); })) keys.push_back(row.key);
  if (scene.pins.empty()) keys.emplace_back("no pins");
  if (scene.sheet.gravity.isZero(0)) keys.emplace_back("no gravity");
  return fmt::format("{}", fmt::join(keys, ", "));
}

FallingSheet numbers(const model::Scene& scene) {
  const model::Grid& grid = scene.sheet.grid;
  const model::Material& material = scene.sheet.material;
  const double size = model::size(scene), g = scene.sheet.gravity.norm(), weight = material.density * size;
  const double k = material.tension.weft, d = material.damping.weft;
  FallingSheet sheet{.particles = grid.particles(), .end = scene.end, .fall_time = std::sqrt(size / g)};
  sheet.damping = d * sheet.fall_time / (weight * size);
  sheet.tension = k / (weight * g);
  const double u = 4 / (grid.spacing_u() * grid.spacing_u()), v = 4 / (grid.spacing_v() * grid.spacing_v());
  sheet.limit =
      solver::verlet_limit({.omega_squared = k / material.density * std::max(u, v), .decay = d / material.density * (u + v)});
  return sheet;
}

std::string in_words(const Prediction& one) {
  if (one.fraction > 0) return fmt::format("{} {:.3g} forces", one.way.method, one.updates);
  return fmt::format("{} {:.3g} updates with h = {:.3g} s", one.way.method, one.updates, one.step);
}

std::string reason(const FallingSheet& sheet, const model::Scene& scene, const std::vector<Prediction>& all) {
  const Prediction& best = all.front();
  std::string text =
      fmt::format("d T/(ρ L²) = {:.3g}, h k/d = {:.3g} with h = {:.3g} s: {} should err by {:.1g} and takes {:.2g} ms",
                  sheet.damping, model::stiffness_to_damping(scene, best.step), best.step, in_words(best), best.error, best.ms);
  if (all.size() > 1) text += fmt::format("; {} take {:.2g} ms", in_words(all[1]), all[1].ms);
  return text;
}

void take(RunSpec& spec, const Prediction& best) {
  choose_method(spec, best.way.method);
  spec.step = best.step;
  spec.options.stage_accuracy = best.way.stage_accuracy;
  spec.options.loop_tolerance = best.way.loop_tolerance;
  if (best.fraction > 0) spec.options.verlet_fraction = best.fraction;
}

/// The step follows pilot runs, which measure the error.
void take_pilots(RunSpec& spec, double accuracy) {
  constexpr const char* usual = "bdf2";
  choose_method(spec, usual);
  spec.step = spec.scene.end / 10;
  spec.options.error_control = {accuracy, model::size(spec.scene), spec.scene.end, true};
}

void require_predictable(const model::Scene& scene) {
  if (model::has_contacts(scene))
    throw std::invalid_argument(
        "--method auto: expected a scene without obstacles and contact.thickness: in contact methods are of first order, and "
        "no rule predicts errors");
  if (model::phases(scene).size() > 1)
    throw std::invalid_argument("--method auto: expected a scene of one phase, without paths");
}

}  // namespace

void choose_automatically(RunSpec& spec, double accuracy) {
  const model::Scene& scene = spec.scene;
  require_predictable(scene);
  std::string unknown = unknown_in(scene);
  if (unknown.empty()) {
    const FallingSheet sheet = numbers(scene);
    unknown = reason_out_of_range(sheet);
    const auto all = unknown.empty() ? predictions(sheet, accuracy) : std::vector<Prediction>();
    if (!all.empty()) {
      take(spec, all.front());
      spec.choice = {accuracy, reason(sheet, scene, all)};
      return;
    }
    if (unknown.empty()) unknown = "this error";
  }
  take_pilots(spec, accuracy);
  spec.choice = {accuracy, fmt::format("the rule was not made for {}: bdf2, with steps that pilot runs of it find", unknown)};
}

}  // namespace drape::bench
