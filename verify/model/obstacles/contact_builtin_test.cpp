// The built-in scenes of one sheet: cloth falls or swings against its obstacles, stays outside, never gains energy and comes to
// rest; scenes without obstacles do no work for contacts.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <tuple>
#include <vector>

#include "verify/support/contact_scenes.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::contact_builtin_test {
namespace {

using namespace contact_scenes;

constexpr double h = 0.01;

/// Without scenes whose pins follow paths: what runs here is the first phase of a scene.
std::vector<std::string> names(bool with_obstacles) {
  std::vector<std::string> found;
  for (const auto& [name, toml] : model::builtin_scenes())
    if (const model::Scene scene = model::load_scene(std::string(name));
        scene.panels.empty() && scene.obstacles.empty() != with_obstacles &&
        std::ranges::all_of(scene.pins, [](const model::PinRule& pin) { return pin.path.empty(); }))
      found.emplace_back(name);
  return found;
}

std::string word(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

/// A method that iterates takes long: it runs through the first impacts only, unless the cloth still falls then. Scenes of
/// table 5.1 end while they swing, and run on.
Trial trial_of(const std::string& name, const std::string& method) {
  if (model::load_scene(name).contact.adaptive) {
    const std::vector<model::Override> longer{{"end.time", "2"}};
    return builtin(name, longer);
  }
  if (method != "bdf2" || name == "mannequin" || name == "sphere_drop") return builtin(name);
  const std::vector<model::Override> shorter{{"end.time", fmt::format("{}", 0.25 * model::load_scene(name).end)}};
  return builtin(name, shorter);
}

double kinetic(const Trial& trial, const Moment& moment) { return kinetic_energy(trial.cloth.ode, moment.y.v); }

class BuiltinContact : public testing::TestWithParam<std::tuple<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(, BuiltinContact,
                         testing::Combine(testing::ValuesIn(names(true)),
                                          testing::Values("sbdf2", "bdf2", "verlet", "bridson")),
                         [](const auto& test) { return word(std::get<0>(test.param) + "_" + std::get<1>(test.param)); });

TEST_P(BuiltinContact, StaysOutsideLosesEnergyAndComesToRest) {
  DRAPE_SLOW_IF(std::get<1>(GetParam()) != "verlet");
  const auto& [name, method] = GetParam();
  const Trial trial = trial_of(name, method);
  const auto moments = run(trial, method, h);
  const auto [least, most] = std::ranges::minmax(moments, {}, &Moment::energy);
  EXPECT_GE(clearance(trial, moments), trial.scene.contact.distance - 1e-9);
  if (!trial.scene.contact.adaptive) {  // what obstacles store in divided springs is not known
    EXPECT_LE(energy_rise(moments), 1e-4 * (most.energy - least.energy)) << "of the energy that was lost";
  }
  EXPECT_GT(moments.back().contacts.constrained, 0);
  const auto fastest = std::ranges::max(moments, {}, [&](const Moment& moment) { return kinetic(trial, moment); });
  EXPECT_LE(kinetic(trial, moments.back()), (method == "bdf2" ? 0.2 : 0.02) * kinetic(trial, fastest));
}

class BuiltinWithoutObstacles : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, BuiltinWithoutObstacles, testing::ValuesIn(names(false)),
                         [](const auto& test) { return word(test.param); });

TEST_P(BuiltinWithoutObstacles, HasNoWorkForContacts) {
  const model::Cloth cloth = model::compile(model::load_scene(GetParam()));
  for (const std::string& method : methods()) solver::Integrator(cloth.ode, solver::method(method), {}, cloth.start).step(1e-4);
  EXPECT_EQ(cloth.contacts, nullptr);
  EXPECT_GT(cloth.ode.work->count("steps"), 0);
  for (const auto& kind : cloth.ode.work->kinds())
    EXPECT_TRUE(kind.name != "obstacle_queries" && kind.name != "constrained_particles" && kind.name != "contact_changes")
        << kind.name;
}

}  // namespace
}  // namespace drape::verify::contact_builtin_test
