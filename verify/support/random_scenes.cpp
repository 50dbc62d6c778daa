#include "verify/support/random_scenes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "verify/support/obstacles.hpp"

namespace drape::verify::random_scenes {
namespace {

using model::Scene;

/// Random numbers of a scene; std::uniform_real_distribution differs between standard libraries.
class Dice {
 public:
  explicit Dice(std::mt19937& random) : random_(random) {}

  double between(double a, double b) { return a + (b - a) * random_() / 4294967296.0; }
  double decades(double a, double b) { return a * std::pow(b / a, between(0, 1)); }
  bool one_in(unsigned n) { return random_() % n == 0; }
  int up_to(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  Eigen::Vector3d direction() {
    const double z = between(-1, 1), angle = between(0, 6.283185307), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  Eigen::Vector3d vector(double shortest, double longest) {
    const double length = decades(shortest, longest);
    return length * direction();
  }

 private:
  std::mt19937& random_;
};

void choose_material(Dice& dice, model::Material& m) {
  m = {};
  m.density = dice.decades(0.1, 2);
  m.tension = {dice.decades(10, 1e4), dice.decades(10, 1e4)};
  if (!dice.one_in(4)) {
    const double d = dice.decades(1e-2, 30);
    m.damping = {d, dice.between(0.5, 2) * d};
  }
  m.damping_form = dice.one_in(3) ? model::DampingForm::projected : model::DampingForm::linear;
  if (!dice.one_in(3)) m.shear = dice.decades(1, 1e3);
  if (dice.one_in(3)) m.shear_damping = dice.decades(1e-3, 1);
  m.shear_form = dice.one_in(3) ? model::ShearForm::printed : model::ShearForm::conservative;
  if (dice.one_in(4)) m.contraction = dice.between(0, 0.8) * std::sqrt(m.tension.weft * m.tension.warp);
  if (dice.one_in(4)) m.contraction_damping = dice.between(0, 0.9) * std::sqrt(m.damping.weft * m.damping.warp);
  if (dice.one_in(3)) return;
  m.bend_form = model::BendForm{dice.up_to(3)};
  m.bend_projected = !dice.one_in(3);
  const bool membrane = m.bend_form == model::BendForm::membrane;
  const double B = membrane ? dice.decades(1e-3, 10) : dice.decades(1e-5, 1e-1);
  m.bend = {B, dice.between(0.5, 2) * B};
  if (dice.one_in(3)) m.bend_damping = {1e-2 * B, 1e-2 * B};
}

void choose_pins(Dice& dice, std::vector<model::PinRule>& pins) {
  pins.clear();
  constexpr const char* places[] = {"upper corners", "upper edge", "left edge", "corners", "border"};
  if (!dice.one_in(5)) pins.push_back({.where = places[dice.up_to(5)], .particles = {}});
  if (dice.one_in(3)) pins.push_back({.where = "right edge", .particles = {}, .velocity = dice.vector(0.1, 3)});
  if (dice.one_in(6) && !pins.empty()) pins.back().directions[static_cast<std::size_t>(dice.up_to(3))] = false;
  if (dice.one_in(6) && !pins.empty()) pins.back().direction = dice.vector(0.1, 3);
}

void choose_obstacle(Dice& dice, Scene& scene) {
  const double gap = dice.between(0.02, 0.2);
  constexpr double radius = 0.3;
  const bool is_plane = dice.one_in(2);
  model::ObstacleRule rule = obstacle(is_plane ? "shape = 'plane'" : fmt::format("shape = 'sphere', radius = {}", radius));
  rule.friction = dice.one_in(2) ? 0.3 : 0;
  const double below = is_plane ? gap : gap + radius;
  const Eigen::Vector3d at(0.4, 0.4, -below);
  rule.motion = {{.t = 0, .position = at}};
  if (dice.one_in(2)) rule.motion.push_back({.t = scene.end, .position = at + scene.end * dice.vector(0.1, 1)});
  scene.obstacles = {rule};
  if (dice.one_in(3)) scene.contact.response = model::ResponseKind::reaction;
}

}  // namespace

Scene random_scene(std::mt19937& random) {
  Dice dice(random);
  Scene scene;
  scene.name = "random";
  scene.end = dice.decades(0.1, 0.6);
  model::Sheet& sheet = scene.sheet;
  sheet.grid = {
      .nu = 4 + dice.up_to(6), .nv = 4 + dice.up_to(6), .size_u = dice.between(0.5, 1.2), .size_v = dice.between(0.5, 1.2)};
  choose_material(dice, sheet.material);
  if (!dice.one_in(3)) sheet.gravity = dice.one_in(3) ? dice.vector(1e-3, 1) : dice.vector(9.81, 9.81);
  if (dice.one_in(5))
    sheet.wind = {.load = dice.vector(0.1, 10), .constant = 0.3, .frequency = dice.between(0, 20), .lift = dice.between(0, 1)};
  if (dice.one_in(5)) sheet.air = dice.decades(1e-2, 1);
  choose_pins(dice, scene.pins);
  if (dice.one_in(3)) scene.start.stretch = {dice.between(0.9, 1.2), dice.between(0.9, 1.2)};
  if (dice.one_in(2)) scene.start.pleats = {1 + dice.up_to(3), dice.between(5, 60)};
  if (dice.one_in(3)) scene.start.velocity = dice.vector(0.1, 3);
  if (dice.one_in(6)) choose_obstacle(dice, scene);
  return scene;
}

}  // namespace drape::verify::random_scenes
