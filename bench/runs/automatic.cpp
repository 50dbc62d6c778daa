#include "bench/runs/automatic.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/runs/choice_rule.hpp"
#include "model/phases.hpp"
#include "solver/stability.hpp"

namespace drape::bench {
namespace {

bool has_curves(const model::Material& m) {
  return m.weft_curve.given() || m.warp_curve.given() || m.shear_curve.given() || m.weft_bend_curve.given() ||
         m.warp_bend_curve.given();
}

bool rubs(const model::Friction& friction) { return friction.shear != 0 || friction.bend.any(); }

bool relaxes(const model::Relaxation& relaxation) {
  return !relaxation.maxwell.empty() || !relaxation.series.empty() || relaxation.quality != 0;
}

bool moves(const model::PinRule& pin) { return !pin.velocity.isZero(0) || !pin.path.empty(); }

bool begins_flat(const model::Start& start) {
  return start.stretch == model::WeftWarp{1, 1} && start.pleats.count == 0 && start.wrap == 0 && start.rotation.isZero(0) &&
         start.velocity.isZero(0);
}

/// What the rule does not know of a scene; empty if it knows all.
std::string unknown_in(const model::Scene& scene) {
  const model::Sheet& sheet = scene.sheet;
  const model::Material& m = sheet.material;
  constexpr double most_shear = 0.05;  // of the tension
  const struct {
    const char* name;
    bool there;
  } all[] = {
      {"panels", !scene.panels.empty()},
      {"a grid that is not uniform", scene.panels.empty() && !sheet.grid.uniform()},
      {"material.tension of two values", m.tension.weft != m.tension.warp},
      {"material.damping of two values", m.damping.weft != m.damping.warp},
      {"material.damping_form", m.damping.any() && m.damping_form != model::DampingForm::linear},
      {"measured curves", has_curves(m)},
      {"material.law", m.law != model::StretchLaw::linear},
      {"material.shear",
       m.shear > most_shear * m.tension.weft || (m.shear > 0 && m.shear_form != model::ShearForm::conservative)},
      {"material.shear_damping", m.shear_damping != 0},
      {"material.contraction", m.contraction != 0 || m.contraction_damping != 0},
      {"material.bend", m.bend.any() || m.bend_damping.any()},
      {"friction of yarns", rubs(m.friction)},
      {"relaxation", relaxes(m.relaxation)},
      {"forces.wind", sheet.wind.blows()},
      {"forces.air", sheet.air != 0},
      {"added forces", !sheet.added.empty()},
      {"a sheet without gravity", sheet.gravity.isZero(0)},
      {"a sheet without pins", scene.pins.empty()},
      {"pins that move", std::ranges::any_of(scene.pins, moves)},
      {"a start that is not flat and at rest", !begins_flat(scene.start)},
  };
  std::vector<std::string_view> names;
  for (const auto& [name, there] : all)
    if (there) names.emplace_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// By an edge if one of the four is pinned from end to end.
Support support_of(const model::Scene& scene) {
  const model::Grid& grid = scene.sheet.grid;
  std::vector<bool> pinned(grid.particles());
  for (const model::PinRule& rule : scene.pins)
    for (const int i : model::pinned_particles(grid, rule)) pinned[i] = true;
  const auto is_edge = [&](int first, int apart, int count) {
    for (int k = 0; k < count; ++k)
      if (!pinned[first + k * apart]) return false;
    return true;
  };
  const bool along_u = is_edge(0, 1, grid.nu) || is_edge(grid.index(0, grid.nv - 1), 1, grid.nu);
  const bool along_v = is_edge(0, grid.nu, grid.nv) || is_edge(grid.nu - 1, grid.nu, grid.nv);
  return along_u || along_v ? Support::edge : Support::points;
}

FallingSheet numbers(const model::Scene& scene) {
  const model::Grid& grid = scene.sheet.grid;
  const model::Material& material = scene.sheet.material;
  const double size = std::max(grid.size_u, grid.size_v), g = scene.sheet.gravity.norm(), weight = material.density * size;
  const double k = material.tension.weft, d = material.damping.weft;
  FallingSheet sheet{
      .support = support_of(scene), .particles = grid.particles(), .end = scene.end, .fall_time = std::sqrt(size / g)};
  sheet.damping = d * sheet.fall_time / (weight * size);
  sheet.tension = k / (weight * g);
  const double u = 4 / (grid.spacing_u() * grid.spacing_u()), v = 4 / (grid.spacing_v() * grid.spacing_v());
  sheet.limit =
      solver::verlet_limit({.omega_squared = k / material.density * std::max(u, v), .decay = d / material.density * (u + v)});
  return sheet;
}

/// "midpoint with h = 0.02 s (160 updates, 1.6 ms)"
std::string in_words(const Prediction& one) {
  std::string name = one.way.method;
  if (one.way.loop_tolerance != solver::Options().loop_tolerance) name += fmt::format(" to {:g}", one.way.loop_tolerance);
  if (one.way.stage_accuracy != solver::Options().stage_accuracy) name += fmt::format(" to {:g}", one.way.stage_accuracy);
  if (one.fraction > 0)
    return fmt::format("{} at {:.2g} of its limit ({:.3g} forces, {:.2g} ms)", name, one.fraction, one.updates, one.ms);
  return fmt::format("{} with h = {:.3g} s ({:.3g} updates, {:.2g} ms)", name, one.step, one.updates, one.ms);
}

std::string reason(const FallingSheet& sheet, const model::Material& material, const std::vector<Prediction>& all) {
  const Prediction& best = all.front();
  const double ratio = best.step * material.tension.weft / material.damping.weft;
  const std::string next = all.size() > 1 ? fmt::format("; next {}", in_words(all[1])) : "";
  return fmt::format("d T/(ρ L²) = {:.3g}, h k/d = {:.3g}: {} should err by {:.1g}{}", sheet.damping, ratio, in_words(best),
                     best.error, next);
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
      spec.choice = {accuracy, reason(sheet, scene.sheet.material, all)};
      return;
    }
    if (unknown.empty()) unknown = "this error";
  }
  take_pilots(spec, accuracy);
  spec.choice = {accuracy, fmt::format("the rule was not made for {}: bdf2, with steps that pilot runs of it find", unknown)};
}

}  // namespace drape::bench
