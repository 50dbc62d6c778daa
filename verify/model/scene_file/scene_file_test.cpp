// Scene files: what they say is what the scene is, also after writing and reading again.

#include "model/scene_file/scene_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <tuple>

#include "model/cloth.hpp"
#include "model/scene_file/toml_nesting.hpp"
#include "verify/support/obstacles.hpp"
#include "verify/support/temporary_folder.hpp"

namespace drape::verify::scene_file_test {
namespace {

using model::Scene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::TestWithParam;

Scene parsed(const std::string& toml, const std::vector<std::string>& set = {}) {
  std::vector<model::Override> overrides;
  for (const std::string& text : set) overrides.push_back(model::parse_override(text));
  return model::parse_scene(toml, "a.toml", overrides);
}

Scene named(const std::string& name) {
  Scene scene;
  scene.name = name;
  return scene;
}

std::pair<double, double> both(const model::WeftWarp& m) { return {m.weft, m.warp}; }

// --- What a file says --------------------------------------------------------------------------------------------------------

const std::string complete = R"(
name = "all"
description = "says \"everything\", with a \\ and a ü"
[grid]
n = [5, 3]
size = [0.6, 0.4]
[material]
density = 0.3
tension = [2000, 1e3]
damping = 2
damping_form = "projected"
shear = 50
shear_damping = 0.2
shear_form = "printed"
contraction = 300
contraction_damping = 0.1
bend = [1e-3, 5e-4]
bend_damping = 0.1
bend_form = "membrane"
bend_projected = true
[forces]
gravity = [0, 0.1, -9.81]
wind = [1, 0, 0.5]
wind_constant = -0.5
wind_frequency = 6
drag = 0.75
lift = 0.25
air = 0.02
[[pins]]
where = "left edge"
[[pins]]
particles = [[3, 0], [3, 2]]
directions = "xz"
velocity = [0.05, 0, 1]
[[pins]]
where = "right edge"
direction = [3, 0, -4]
[[obstacles]]
shape = "plane"
[[obstacles]]
shape = "box"
size = [1, 2.5, 3]
friction = 0.3
position = [0.1, 0, -1]
rotation = [0, 90, 0]
[[obstacles]]
shape = "sphere"
radius = 0.75
vertices = 50
motion = [{ time = 0.5, position = [0, 0, 1] }, { time = 1, rotation = [0, 0, 45.5] }]
[[obstacles]]
shape = "cylinder"
radius = 0.6
height = 0.05
[contact]
distance = 2e-3
relaxation = 1
response = "reaction"
detection = "ray"
reaction_time = 0.01
push = 20
exponent = 12
range = 2e-3
restitution = 0.25
adaptive = true
[start]
plane = "vertical"
stretch = [1.1, 1]
pleats = [2, 40.5]
velocity = [0, 0.3, 0]
[end]
time = 0.5
)";

void expect_frame(const model::KeyFrame& frame, double t, const Eigen::Vector3d& position, const Eigen::Vector3d& rotation) {
  EXPECT_EQ(frame.t, t);
  EXPECT_EQ(frame.position, position);
  EXPECT_EQ(frame.rotation, rotation);
}

/// The obstacles as `complete` says them.
void expect_obstacles(const std::vector<model::ObstacleRule>& obstacles) {
  ASSERT_EQ(obstacles.size(), 4u);
  const auto& [plane, box, sphere, cylinder] = std::tie(obstacles[0], obstacles[1], obstacles[2], obstacles[3]);
  EXPECT_EQ(plane.kind->name, "plane");
  EXPECT_EQ(plane.friction, 0);
  ASSERT_EQ(plane.motion.size(), 1u);
  expect_frame(plane.motion[0], 0, {0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(box.kind->name, "box");
  EXPECT_EQ(value_of(box, "size"), "[1, 2.5, 3]");
  EXPECT_EQ(box.friction, 0.3);
  ASSERT_EQ(box.motion.size(), 1u);
  expect_frame(box.motion[0], 0, {0.1, 0, -1}, {0, 90, 0});
  EXPECT_EQ(sphere.kind->name, "sphere");
  EXPECT_EQ(value_of(sphere, "radius"), "0.75");
  EXPECT_EQ(value_of(sphere, "vertices"), "50");
  ASSERT_EQ(sphere.motion.size(), 2u);
  expect_frame(sphere.motion[0], 0.5, {0, 0, 1}, {0, 0, 0});
  expect_frame(sphere.motion[1], 1, {0, 0, 0}, {0, 0, 45.5});
  EXPECT_EQ(cylinder.kind->name, "cylinder");
  EXPECT_EQ(value_of(cylinder, "radius"), "0.6");
  EXPECT_EQ(value_of(cylinder, "height"), "0.05");
}

/// Every key as `complete` says it.
void expect_complete(const Scene& scene) {
  EXPECT_EQ(scene.name, "all");
  EXPECT_EQ(scene.description, "says \"everything\", with a \\ and a ü");
  const auto& [grid, material, gravity, wind, air, rest, added] = scene.sheet;
  EXPECT_EQ(rest.size(), 0) << "flat";
  EXPECT_TRUE(added.empty());
  EXPECT_THAT((std::array{grid.nu, grid.nv}), ElementsAre(5, 3));
  EXPECT_THAT((std::array{grid.size_u, grid.size_v}), ElementsAre(0.6, 0.4));
  EXPECT_EQ(material.density, 0.3);
  EXPECT_THAT(both(material.tension), Pair(2000, 1000));
  EXPECT_THAT(both(material.damping), Pair(2, 2));
  EXPECT_EQ(material.damping_form, model::DampingForm::projected);
  EXPECT_EQ(material.shear, 50);
  EXPECT_EQ(material.shear_damping, 0.2);
  EXPECT_EQ(material.shear_form, model::ShearForm::printed);
  EXPECT_EQ(material.contraction, 300);
  EXPECT_EQ(material.contraction_damping, 0.1);
  EXPECT_THAT(both(material.bend), Pair(1e-3, 5e-4));
  EXPECT_THAT(both(material.bend_damping), Pair(0.1, 0.1));
  EXPECT_EQ(material.bend_form, model::BendForm::membrane);
  EXPECT_TRUE(material.bend_projected);
  EXPECT_EQ(gravity, Eigen::Vector3d(0, 0.1, -9.81));
  EXPECT_EQ(wind.load, Eigen::Vector3d(1, 0, 0.5));
  EXPECT_EQ(wind.constant, -0.5);
  EXPECT_EQ(wind.frequency, 6);
  EXPECT_EQ(wind.drag, 0.75);
  EXPECT_EQ(wind.lift, 0.25);
  EXPECT_EQ(air, 0.02);
  EXPECT_EQ(scene.start.plane, model::Plane::vertical);
  EXPECT_THAT(both(scene.start.stretch), Pair(1.1, 1));
  EXPECT_EQ(scene.start.pleats.count, 2);
  EXPECT_EQ(scene.start.pleats.degrees, 40.5);
  EXPECT_EQ(scene.start.velocity, Eigen::Vector3d(0, 0.3, 0));
  EXPECT_EQ(scene.end, 0.5);
  expect_obstacles(scene.obstacles);
  EXPECT_EQ(scene.contact.distance, 2e-3);
  EXPECT_EQ(scene.contact.relaxation, 1);
  EXPECT_EQ(scene.contact.response, model::ResponseKind::reaction);
  EXPECT_EQ(scene.contact.detection, model::DetectionKind::ray);
  EXPECT_EQ(scene.contact.reaction_time, 0.01);
  EXPECT_EQ(scene.contact.push, 20);
  EXPECT_EQ(scene.contact.exponent, 12);
  EXPECT_EQ(scene.contact.range, 2e-3);
  EXPECT_EQ(scene.contact.restitution, 0.25);
  EXPECT_TRUE(scene.contact.adaptive);
  ASSERT_EQ(scene.pins.size(), 3u);
  EXPECT_EQ(scene.pins[0].where, "left edge");
  EXPECT_THAT(scene.pins[0].directions, ElementsAre(true, true, true));
  EXPECT_EQ(scene.pins[0].velocity, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(scene.pins[1].where, "");
  EXPECT_THAT(scene.pins[1].particles, ElementsAre(Pair(3, 0), Pair(3, 2)));
  EXPECT_THAT(scene.pins[1].directions, ElementsAre(true, false, true));
  EXPECT_EQ(scene.pins[1].velocity, Eigen::Vector3d(0.05, 0, 1));
  EXPECT_FALSE(scene.pins[1].oblique());
  EXPECT_EQ(scene.pins[2].direction, Eigen::Vector3d(3, 0, -4));
}

TEST(SceneFile, SaysWhatTheSceneIs) { expect_complete(parsed(complete)); }

TEST(SceneFile, SaysTheSameAfterWriting) { expect_complete(parsed(to_toml(parsed(complete)))); }

TEST(SceneFile, MayLeaveOutAllButTheName) { EXPECT_EQ(to_toml(parsed("name = 'x'")), to_toml(named("x"))); }

TEST(SceneFile, WithoutANameIsCalledAsItsFile) {
  EXPECT_EQ(model::parse_scene("grid.n = 3", "some/where/my cotton.toml").name, "my cotton");
  EXPECT_EQ(model::parse_scene("name = 'x'", "some/where/cotton.toml").name, "x");
}

TEST(SceneFile, IsTheSameAfterWritingAndReadingAgain) {
  std::vector<Scene> scenes{parsed(complete), named("x")};
  for (const auto& builtin : model::builtin_scenes()) scenes.push_back(model::load_scene(std::string(builtin.name)));
  for (const Scene& scene : scenes) EXPECT_EQ(to_toml(parsed(to_toml(scene))), to_toml(scene));
}

TEST(SceneFile, KeepsEveryNumberToTheLastBit) {
  for (const double number : {0.1, 1.0 / 3, 1e300, 1e-300, 1e15, 123456789012345678.0}) {
    Scene scene = named("x");
    scene.sheet.material.density = number;
    EXPECT_EQ(parsed(to_toml(scene)).sheet.material.density, number);
  }
}

TEST(SceneFile, KeepsEveryText) {
  for (const std::string text :
       {"", "it's", "a \"b\" \\ c", "\n'''\n", "\n\"\"\"\n", "\nbegins with a line", "ü \t", "\r\n", "\\u00e9"}) {
    Scene scene = named("x");
    scene.description = text;
    EXPECT_EQ(parsed(to_toml(scene)).description, text);
  }
}

TEST(SceneFile, MayHoldAnyNumberOfBracketsAndDotsInTextsAndComments) {
  const std::string many = std::string(1000, '[') + std::string(1000, '{') + std::string(1000, '.');
  for (const std::string quotes : {"'", "\"", "'''", "\"\"\""})
    EXPECT_EQ(parsed("name = 'x'\ndescription = " + quotes + many + quotes + " # " + many + "'\n").description, many);
  EXPECT_EQ(parsed("name = 'x'\ndescription = \"\\\"" + many + "\"\n").description, "\"" + many);
  EXPECT_EQ(parsed("name = 'x'\ndescription = \"\"\"\n\"\"" + many + "\n\"\"\"\n").description, "\"\"" + many + "\n");
}

TEST(TomlNesting, IsFoundOnTheLineWhereItGoesTooDeep) {
  EXPECT_EQ(model::line_nested_deeper("a = [[1, 2],\n[3, 4]]\nb.c = {d = [1.5, 2.5]}\n", 2), 0);
  EXPECT_EQ(model::line_nested_deeper("a = [[1, 2],\n[3, [4]]]\n", 2), 2);
  EXPECT_EQ(model::line_nested_deeper("\n\na.b.c = 1\n", 2), 3);
  EXPECT_EQ(model::line_nested_deeper("[a.'b'. \"c\"]\n", 2), 1);
  EXPECT_EQ(model::line_nested_deeper("a = '''\n[[[\n'''\nb = [[[", 2), 4) << "behind a text of three lines";
  EXPECT_EQ(model::line_nested_deeper("a = [\"\"\"x\"\"\"\", [[[1]]]]\n", 2), 1) << "behind a text that ends in a quote";
  EXPECT_EQ(model::line_nested_deeper("a = '[[[\nb = [[[", 2), 2) << "behind a text without an end";
}

TEST(SceneFile, HasAHelpForEveryKeyItWrites) {
  const std::string text = to_toml(named("x"));
  for (const auto& [path, description] : model::scene_keys()) {
    EXPECT_FALSE(description.empty()) << path;
    EXPECT_THAT("\n" + text, HasSubstr("\n" + path + " = "));
  }
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), model::scene_keys().size());
}

/// As a run is recorded.
std::vector<model::Override> rows_of(const Scene& scene) {
  std::vector<model::Override> rows;
  for (const model::KeyValue& row : model::key_values(scene)) rows.push_back({row.key, to_toml(row.value)});
  return rows;
}

TEST(SceneFile, IsTheSameAfterItsRowsAreReadAgain) {
  for (const Scene& scene : {parsed(complete), parsed(complete, {"pins=[]"}), named("x"), model::load_scene("skirt"),
                             model::load_scene("sewn_dress")})
    EXPECT_EQ(to_toml(model::scene_of(rows_of(scene), "rows")), to_toml(scene));
}

TEST(SceneFile, HasARowForEveryKeyAndEveryEntryOfAList) {
  std::vector<std::string> keys;
  for (const model::KeyValue& row : model::key_values(parsed(complete))) keys.push_back(row.key);
  EXPECT_EQ(std::ranges::count(keys, "pins"), 3);
  EXPECT_EQ(std::ranges::count(keys, "obstacles"), 4);
  const std::size_t empty = 22;  // sides, a cut, curves, tables, elements of relaxation, panels, seams, phases
  EXPECT_EQ(keys.size(), model::scene_keys().size() + 2 + 3 - empty);
}

TEST(SceneFile, HasTheUnitOfEveryKeyInItsHelpAndItsRow) {
  const auto unit = [](const Scene& scene, std::string_view key) {
    const std::vector<model::KeyValue> rows = model::key_values(scene);
    const auto row = std::ranges::find(rows, key, &model::KeyValue::key);
    return row == rows.end() ? std::string() : std::string(row->unit);
  };
  EXPECT_EQ(unit(parsed(complete), "material.bend"), "N/m") << "of the membrane";
  EXPECT_EQ(unit(named("x"), "material.bend"), "N m") << "of the plate";
  EXPECT_EQ(unit(named("x"), "forces.drag"), "1");
  EXPECT_EQ(unit(parsed(complete), "pins"), "");
  for (const auto& [path, description] : model::scene_keys()) {
    const std::string of_key = unit(parsed(complete, {"material.bend_form=plate"}), path);
    if (of_key.size() > 1) {
      EXPECT_THAT(description, HasSubstr("[" + of_key.substr(0, 3))) << path;
    }
  }
}

TEST(SceneFile, NamesAllShapesInItsHelp) {
  const std::vector<model::KeyHelp> keys = model::scene_keys();
  const std::string help = std::ranges::find(keys, "obstacles", &model::KeyHelp::path)->description;
  EXPECT_THAT(
      help,
      HasSubstr(
          "shape = plane | sphere, radius, vertices | box, size | cylinder, radius, height | mannequin, height, arms, legs, "
          "walk, walk_from | mesh, file, "));
}

TEST(SceneFile, IsReadFromDisk) {
  const base::TemporaryFolder folder;
  const std::string file = folder / "scene.toml";
  std::ofstream(file) << complete;
  EXPECT_EQ(to_toml(model::load_scene(file)), to_toml(parsed(complete)));
}

// --- Scenes that change others -----------------------------------------------------------------------------------------------

TEST(BaseOfAScene, IsChangedByItsKeys) {
  const Scene changed = parsed("base = 'hung-edge'\nname = 'other'\nmaterial.damping = 3\n[[pins]]\nwhere = 'corners'");
  Scene expected = model::load_scene("hung-edge");
  expected.name = "other";
  expected.sheet.material.damping = {3, 3};
  expected.pins = {{.where = "corners", .particles = {}}};
  EXPECT_EQ(to_toml(changed), to_toml(expected));
}

TEST(BaseOfAScene, MayBeAFileBesideIt) {
  const TemporaryFolder folder;
  std::ofstream(folder / "base.toml") << complete;
  std::ofstream(folder / "derived.toml") << "base = 'base.toml'\nmaterial.density = 7";
  Scene expected = parsed(complete, {"material.density=7"});
  expected.name = "derived";
  EXPECT_EQ(to_toml(model::load_scene(folder / "derived.toml")), to_toml(expected));
}

TEST(BaseOfAScene, IsOverriddenAfterAll) { EXPECT_EQ(parsed("base = 'hung-edge'\ngrid.n = 5", {"grid.n=7"}).sheet.grid.nu, 7); }

// --- Built-in scenes ---------------------------------------------------------------------------------------------------------

class BuiltinScene : public TestWithParam<model::BuiltinScene> {};
INSTANTIATE_TEST_SUITE_P(, BuiltinScene, testing::ValuesIn(model::builtin_scenes()), [](const auto& test) {
  std::string name(test.param.name);
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(BuiltinScene, CompilesAndHasFiniteForces) {
  const Scene scene = model::load_scene(std::string(GetParam().name));
  EXPECT_EQ(scene.name, GetParam().name);
  EXPECT_FALSE(scene.description.empty());
  const model::Cloth cloth = model::compile(scene);
  solver::Vectors f;
  solver::SparseMatrix dx, dv;
  cloth.ode.force(0, cloth.start.x, cloth.start.v, f);
  EXPECT_TRUE(f.allFinite());
  EXPECT_GT(f.cwiseAbs().maxCoeff(), 0);
  cloth.ode.jacobian(0, cloth.start.x, cloth.start.v, dx, dv);
  EXPECT_TRUE(dx.coeffs().isFinite().all() && dv.coeffs().isFinite().all());
  EXPECT_GT(cloth.plan.pinned_dofs + cloth.plan.obstacles, 0) << "nothing holds it";
}

// --- Overrides
// -----------------------------------------------------------------------------------------------------------------

TEST(Override, OfTheResolutionKeepsTheSides) {
  const model::Grid grid = parsed(complete, {"grid.n=40"}).sheet.grid;
  EXPECT_THAT((std::array{grid.nu, grid.nv}), ElementsAre(40, 40));
  EXPECT_THAT((std::array{grid.size_u, grid.size_v}), ElementsAre(0.6, 0.4));
}

TEST(Override, OfAModulusSetsBothDirectionsOrEach) {
  EXPECT_THAT(both(parsed(complete, {"material.tension=3e3"}).sheet.material.tension), Pair(3000, 3000));
  EXPECT_THAT(both(parsed(complete, {"material.tension=[4000, 3e3]"}).sheet.material.tension), Pair(4000, 3000));
}

TEST(Override, MayBeABareWordOrInQuotes) {
  EXPECT_EQ(parsed(complete, {"material.shear_form=conservative"}).sheet.material.shear_form, model::ShearForm::conservative);
  EXPECT_EQ(parsed(complete, {"start.plane='horizontal'"}).start.plane, model::Plane::horizontal);
  EXPECT_EQ(parsed(complete, {"description=two words = one"}).description, "two words = one");
}

TEST(Override, MayReplaceAllPins) {
  EXPECT_TRUE(parsed(complete, {"pins=[]"}).pins.empty());
  EXPECT_EQ(parsed(complete, {"pins=[{where='corners'}]"}).pins.at(0).where, "corners");
}

TEST(Override, MayNameWhatTheFileDoesNot) { EXPECT_EQ(parsed("name = 'x'", {"material.shear=7"}).sheet.material.shear, 7); }

TEST(Override, ThatComesLaterWins) { EXPECT_EQ(parsed(complete, {"end.time=1", "end.time=2"}).end, 2); }

TEST(Override, AppliesToBuiltinScenesToo) {
  const model::Override half{"end.time", "0.25"};
  EXPECT_EQ(model::load_scene("hung-edge", std::span(&half, 1)).end, 0.25);
}

}  // namespace
}  // namespace drape::verify::scene_file_test
