// Scenes that differ in the units of length, time and mass move alike: nothing in the program has a size of its own.
//
// Factors are powers of two, so that every rounding is the same and motions are equal to the last bit, with equal work.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "verify/support/slow.hpp"
#include "verify/support/small_problems.hpp"

namespace drape::verify::similarity_test {
namespace {

using namespace small_problems;
using solver::Integrator;
using solver::Method;
using solver::Outcome;

/// Factors of lengths, times and densities.
struct Units {
  double a = 1, b = 1, c = 1;

  double moduli() const { return c * a * a / (b * b); }  ///< of [N/m]
  double viscosities() const { return c * a * a / b; }   ///< of [N s/m]
};
constexpr Units other_units[] = {{4, 1, 1}, {1, 4, 1}, {1, 1, 4}, {0.25, 2, 16}};

struct Case {
  std::string name;
  std::string (*toml)(const Units&);
  bool obstacles = false;
};

/// A sheet with forces of every kind, hung by two corners.
std::string sheet(const Units& u) {
  const auto [a, b, c] = u;
  const double moduli = u.moduli(), viscosities = u.viscosities();
  return fmt::format(
      "grid = {{ n = [6, 5], size = [{}, {}] }}\n"
      "material = {{ density = {}, tension = [{}, {}], damping = {}, shear = {}, shear_damping = {}, contraction = {}, bend = "
      "{}, "
      "bend_damping = {} }}\n"
      "forces = {{ gravity = [0, {}, {}], wind = [{}, 0, {}], wind_frequency = {}, lift = 0.5, air = {} }}\n"
      "pins = [{{ where = 'upper corners' }}]\nstart = {{ stretch = [1.25, 1] }}\n",
      0.5 * a, 0.375 * a, 0.25 * c, 300 * moduli, 500 * moduli, 2 * viscosities, 20 * moduli, 0.125 * viscosities, 30 * moduli,
      0.0009765625 * moduli * a * a, 0.0001220703125 * viscosities * a * a, 1.5 * a / (b * b), -9.5 * a / (b * b),
      1.5 * c * a / (b * b), 0.5 * c * a / (b * b), 6 / b, 0.0625 * c / b);
}

/// A sheet with membrane bending and projected damping falls on a ball; `response`: to contact.
std::string fall(const Units& u, const char* response) {
  const auto [a, b, c] = u;
  const double moduli = u.moduli(), viscosities = u.viscosities();
  return fmt::format(
      "grid = {{ n = 6, size = {} }}\n"
      "material = {{ density = {}, tension = {}, damping = {}, damping_form = 'projected', shear = {}, bend = {}, "
      "bend_form = 'membrane' }}\n"
      "forces.gravity = [0, {}, {}]\n"
      "contact = {{ distance = {}, response = '{}', reaction_time = {} }}\n"
      "obstacles = [{{ shape = 'sphere', radius = {}, position = [{}, {}, {}], friction = 0.25 }}]\n",
      0.5 * a, 0.25 * c, 300 * moduli, 2 * viscosities, 20 * moduli, 0.5 * moduli, 1.5 * a / (b * b), -9.5 * a / (b * b),
      0.0078125 * a, response, 0.03125 * b, 0.25 * a, 0.25 * a, 0.1875 * a, -0.28125 * a);
}
const Case cases[] = {{"sheet", sheet},
                      {"constraint", [](const Units& u) { return fall(u, "constraint"); }, true},
                      {"reaction", [](const Units& u) { return fall(u, "reaction"); }, true}};

/// The end of a run, in the units of the first, and its work.
struct Moved {
  Outcome outcome = Outcome::success;
  solver::State end;
  std::vector<std::int64_t> work;
  std::int64_t contacts = 0;
};

Moved run(const Case& scene, const Method& method, const solver::Options& options, const Units& u) {
  constexpr int steps = 60;
  constexpr double h = 1.0 / 256;
  const model::Cloth cloth = model::compile(model::parse_scene("name = 'similar'\nend.time = 1\n" + scene.toml(u), scene.name));
  Integrator integrator(cloth.ode, method, options, cloth.start);
  Moved all;
  for (int k = 0; k < steps && all.outcome == Outcome::success; ++k) {
    all.outcome = integrator.step(h * u.b).outcome;
    all.contacts += integrator.contacts().constrained;
  }
  all.end = {integrator.state().x / u.a, integrator.state().v * (u.b / u.a)};
  for (const solver::Counters::Kind& kind : cloth.ode.work->kinds()) all.work.push_back(kind.count);
  return all;
}

class Similar : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, Similar, testing::ValuesIn(names(solver::methods())),
                         [](const auto& test) { return identifier(test.param); });

TEST_P(Similar, ScenesMoveAlikeToTheLastBit) {
  DRAPE_SLOW();
  const Method& method = solver::method(GetParam());
  for (const Case& scene : cases) {
    if (method.needs_energies || (scene.obstacles && !method.meets_obstacles)) continue;
    for (const solver::Options& options : {solver::Options(), solver::thesis_options()}) {
      const Moved first = run(scene, method, options, {});
      EXPECT_TRUE(first.contacts > 0 || first.outcome != Outcome::success || scene.name != "constraint") << scene.name;
      for (const Units& u : other_units) {
        const Moved other = run(scene, method, options, u);
        const std::string what = fmt::format("{}, lengths × {}, times × {}, densities × {}", scene.name, u.a, u.b, u.c);
        EXPECT_EQ(other.outcome, first.outcome) << what;
        EXPECT_EQ((other.end.x - first.end.x).norm(), 0) << what;
        EXPECT_EQ((other.end.v - first.end.v).norm(), 0) << what;
        EXPECT_EQ(other.work, first.work) << what;
      }
    }
  }
}

/// Another ratio of a stiffness to the units is another scene.
TEST(SimilarScenes, HaveEqualRatios) {
  const auto lifted = [](const Units& u) {
    std::string text = sheet(u);
    return text.replace(text.find("lift = 0.5"), 10, "lift = 0.6");
  };
  const Moved first = run(cases[0], solver::method("bdf2"), {}, {}),
              other = run({"other", lifted}, solver::method("bdf2"), {}, {});
  EXPECT_GT((other.end.x - first.end.x).norm(), 1e-6);
}

}  // namespace
}  // namespace drape::verify::similarity_test
