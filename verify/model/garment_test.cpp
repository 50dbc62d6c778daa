// Garments: panels that are sewn together.

#include "model/garment.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "solver/methods.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::garment_test {
namespace {

using model::Garment;
using model::PanelRule;
using model::PanelSide;
using testing::HasSubstr;
using namespace sheets;

constexpr double rounding = 1000 * std::numeric_limits<double>::epsilon();

const Grid whole{9, 4, 1.6, 0.6};

PanelRule half(const std::string& name, const Material& material, double begin) {
  PanelRule panel{name, "", {5, 4, 0.8, 0.6}, material, {}};
  panel.start.position[0] = begin;
  return panel;
}

/// The sheet above, cut along its middle and sewn again.
Scene sewn(const ForceCase& force) {
  Scene scene = scene_of(force, Grid());
  scene.panels = {half("left", force.material, 0), half("right", force.material, 0.8)};
  scene.seams = {{{"left", PanelSide::right, {}}, {"right", PanelSide::left, {}}}};
  return scene;
}

/// The particle of the whole sheet that each node is.
std::vector<int> particles_of_nodes(const Garment& garment) {
  std::vector<int> all(static_cast<std::size_t>(garment.nodes()), -1);
  for (int p = 0; p < 2; ++p)
    for (int i = 0; i < 20; ++i)
      all[static_cast<std::size_t>(garment.panels()[static_cast<std::size_t>(p)].node(i))] = whole.index(i % 5 + 4 * p, i / 5);
  return all;
}

Vectors reordered(const Vectors& of_whole, const std::vector<int>& particles) { return of_whole(particles, Eigen::all); }

/// Forces of edges and cells: a seam does not bend, and what is bent ends there.
ForceCase of_edges_and_cells() {
  ForceCase force = force_case("gravity");
  force.material = made_of(tension, linear_damping, shear, contraction);
  return force;
}

TEST(Garments, OfTwoHalvesAreTheWhole) {
  const ForceCase force = of_edges_and_cells();
  const Scene scene = sewn(force);
  const model::Cloth garment = model::compile(scene), sheet = model::compile(scene_of(force, whole));
  ASSERT_EQ(garment.ode.particles(), whole.particles());
  const std::vector<int> particles = particles_of_nodes(*garment.garment);
  EXPECT_LE(largest(garment.ode.mass - sheet.ode.mass(particles)), rounding);
  EXPECT_LE(largest(garment.garment->areas() - whole.cell_areas()(particles)), rounding);
  EXPECT_LE(largest(garment.start.x - reordered(sheet.start.x, particles)), rounding);
  const State y = deformed(whole, 1), own{reordered(y.x, particles), reordered(y.v, particles)};
  EXPECT_LE(largest(evaluate(garment.ode.force, own) - reordered(evaluate(sheet.ode.force, y), particles)), rounding);
  EXPECT_LE(largest(evaluate(garment.ode.explicit_force, own) - reordered(evaluate(sheet.ode.explicit_force, y), particles)),
            rounding);
  EXPECT_NEAR(garment.ode.potential_energy(0, own.x), sheet.ode.potential_energy(0, y.x), rounding);
  EXPECT_LE(largest(garment.ode.stiffness * own.x - reordered(sheet.ode.stiffness * y.x, particles)), rounding);
  EXPECT_LE(largest(garment.ode.damping * own.v - reordered(sheet.ode.damping * y.v, particles)), rounding);
  EXPECT_EQ(garment.plan.terms, sheet.plan.terms);
}

class SewnMotion : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(, SewnMotion,
                         testing::Values("imex-euler", "sbdf2", "bdf2", "bdf2/newton", "verlet", "energy-momentum", "xpbd",
                                         "ros3p"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name;
                         });

TEST_P(SewnMotion, IsThatOfTheWhole) {
  const std::string name = GetParam().substr(0, GetParam().find('/'));
  const ForceCase force = of_edges_and_cells();
  const auto end = [&](const Scene& scene, const std::function<State(const model::Cloth&)>& start) {
    const model::Cloth cloth = model::compile(scene);
    solver::Options options;
    options.loop_tolerance = options.cg_tolerance = 1e-14;
    if (GetParam().ends_with("/newton")) options.stage = &solver::stage_kind("newton");
    solver::Integrator integrator(cloth.ode, solver::method(name), options, start(cloth));
    EXPECT_EQ(integrate(integrator, 0.2, 0.01).outcome, solver::Outcome::success);
    return integrator.state();
  };
  const State begin = deformed(whole, 2);
  std::vector<int> particles;
  const State garment = end(sewn(force), [&](const model::Cloth& cloth) {
    particles = particles_of_nodes(*cloth.garment);
    return State{reordered(begin.x, particles), reordered(begin.v, particles)};
  });
  const State sheet = end(scene_of(force, whole), [&](const model::Cloth&) { return begin; });
  // xpbd's sweeps go through the constraints in another order.
  EXPECT_LE(largest(garment.x - reordered(sheet.x, particles)), name == "xpbd" ? 1e-2 : 1e-9);
}

/// What remembers the motion is told of the panels' own particles.
TEST(Garments, RememberAsTheWhole) {
  for (const auto& remember : {+[](Material& m) {
                                 m.relaxation.maxwell = {{3, 0.3}, {20, 0.2}};
                               },
                               +[](Material& m) {
                                 m.tension = {};
                                 curves(m);
                               },
                               +[](Material& m) { m.friction.shear = 0.3, m.friction.shear_onset = 0.2; }}) {
    ForceCase force = of_edges_and_cells();
    remember(force.material);
    const auto end = [&](const Scene& scene, auto reorder) {
      const model::Cloth cloth = model::compile(scene);
      EXPECT_GT(cloth.plan.internal_variables, 0);
      const State begin = deformed(whole, 3);
      State start = cloth.start;
      start.x = reorder(*cloth.garment, begin.x), start.v = reorder(*cloth.garment, begin.v);
      solver::Integrator integrator(cloth.ode, solver::method("bdf2"), {}, start);
      EXPECT_EQ(integrate(integrator, 0.2, 0.01).outcome, solver::Outcome::success);
      return integrator.state().x;
    };
    std::vector<int> particles;
    const Vectors garment = end(sewn(force), [&](const Garment& of, const Vectors& x) {
      particles = particles_of_nodes(of);
      return reordered(x, particles);
    });
    const Vectors sheet = end(scene_of(force, whole), [](const Garment&, const Vectors& x) { return x; });
    EXPECT_LE(largest(garment - reordered(sheet, particles)), 1e-6);
  }
}

void expect_jacobian_of_forces(const model::Cloth& cloth, const std::vector<int>& nodes) {
  const int n = cloth.ode.particles();
  const State y{cloth.start.x + random_vectors(n, 0.04, 1), random_vectors(n, 0.3, 2)};
  SparseMatrix df_dx, df_dv;
  cloth.ode.jacobian(0, y.x, y.v, df_dx, df_dv);
  constexpr double step = 1e-6;
  for (const int k : nodes)
    for (int c = 0; c < 3; ++c) {
      State plus = y, minus = y, faster = y, slower = y;
      plus.x(k, c) += step, minus.x(k, c) -= step, faster.v(k, c) += step, slower.v(k, c) -= step;
      const auto column = [&](const SparseMatrix& matrix) {
        return Eigen::VectorXd(Eigen::MatrixXd(matrix).col(3 * k + c)).reshaped<Eigen::RowMajor>(n, 3).eval();
      };
      const Vectors by_x = (evaluate(cloth.ode.force, plus) - evaluate(cloth.ode.force, minus)) / (2 * step);
      const Vectors by_v = (evaluate(cloth.ode.force, faster) - evaluate(cloth.ode.force, slower)) / (2 * step);
      EXPECT_LE(largest(by_x - column(df_dx)), 1e-6 * largest(by_x));
      EXPECT_LE(largest(by_v - column(df_dv)), 1e-6 * std::max(1.0, largest(by_v)));
    }
}

/// With everything that a sheet can have, bending and normals included, on a tube that is sewn to a second panel.
TEST(Garments, HaveTheJacobianOfTheirForces) {
  ForceCase force = force_case("all_of_the_thesis");
  Scene scene = scene_of(force, Grid());
  scene.panels = {{"tube", "", {6, 4, 1.2, 0.6}, force.material, {}}, {"cuff", "", {6, 3, 1.2, 0.4}, force.material, {}}};
  scene.seams = {{{"tube", PanelSide::left, {}}, {"tube", PanelSide::right, {}}},
                 {{"cuff", PanelSide::left, {}}, {"cuff", PanelSide::right, {}}},
                 {{"tube", PanelSide::upper, {}}, {"cuff", PanelSide::lower, {}}}};
  for (PanelRule& panel : scene.panels) {
    panel.material.shear_form = ShearForm::conservative;
    panel.start.plane = model::Plane::vertical, panel.start.wrap = 1;
  }
  scene.panels[1].start.position[2] = 0.6;
  const model::Cloth cloth = model::compile(scene);
  ASSERT_EQ(cloth.ode.particles(), 5 * 4 + 5 * 3 - 5);
  expect_jacobian_of_forces(cloth, {0, 1, 5 * 3 + 2, cloth.ode.particles() - 1});
}

/// At the tip of a dart both neighbours along the border are one.
TEST(Garments, HaveNormalsAtTheTipsOfDarts) {
  ForceCase force = force_case("all_of_the_thesis");
  force.material.shear_form = ShearForm::conservative;
  Scene scene = scene_of(force, Grid());
  scene.panels = {{"front", "", {6, 4, 1.2, 0.6}, force.material, {}}};
  scene.seams = {{{"front", PanelSide::upper, {3, 2}}, {"front", PanelSide::upper, {1, 2}}}};
  const model::Cloth cloth = model::compile(scene);
  ASSERT_EQ(cloth.ode.particles(), 6 * 4 - 1);
  constexpr int first_of_border = 6 * 3;
  expect_jacobian_of_forces(cloth, {first_of_border - 4, first_of_border + 1, first_of_border + 2});
}

/// The two ends of a wrapped panel meet, and lines keep their lengths.
TEST(Garments, AreWrappedWithoutStrain) {
  model::Start start;
  start.plane = model::Plane::vertical, start.wrap = 0.6;
  const Grid grid{400, 3, 0.8, 0.2};
  const Vectors x = model::start_of(grid, start).x;
  for (int b = 0; b < 3; ++b) {
    for (int a = 1; a < grid.nu; ++a)
      ASSERT_NEAR((x.row(grid.index(a, b)) - x.row(grid.index(a - 1, b))).norm(), grid.spacing_u(), 1e-4 * grid.spacing_u());
    EXPECT_NEAR(x(grid.index(0, b), 0), -x(grid.index(399, b), 0), 1e-9);
    EXPECT_NEAR(x(grid.index(0, b), 1), 0, 1e-9);
    EXPECT_NEAR(x(grid.index(399, b), 1), 0, 1e-9);
    EXPECT_NEAR(x(grid.index(7, b), 2), 0.1 * b, rounding);
  }
  const double width = x(grid.index(399, 0), 0), depth = -x.col(1).minCoeff();
  EXPECT_NEAR(depth / width, 0.6, 1e-4);
  start.rotation = {0, 0, 90}, start.position = {1, 2, 3};
  const Vectors moved = model::start_of(grid, start).x;
  EXPECT_LE((moved.row(0) - Eigen::RowVector3d(1 - x(0, 1), 2 + x(0, 0), 3)).norm(), rounding);
}

constexpr const char* two_panels =
    "name = 'two'\n"
    "panels = [{name = 'a', grid.n = [3, 4], grid.size = [0.2, 0.6]}, {name = 'b', grid.n = [4, 4], grid.size = [0.3, 0.6], "
    "material.tension = 7}]\n"
    "material.tension = 5\n";

TEST(GarmentFiles, HavePanelsThatChangeTheScene) {
  const Scene scene =
      model::parse_scene(fmt::format("{}seams = [{{one = {{panel = 'a', side = 'right'}}, other = {{panel = 'b', "
                                     "side = 'left'}}}}]\npins = [{{panel = 'b', where = 'right edge'}}]",
                                     two_panels),
                         "a.toml");
  const model::Cloth cloth = model::compile(scene);
  EXPECT_EQ(cloth.ode.particles(), 12 + 16 - 4);
  EXPECT_EQ(cloth.garment->panel("a").sheet.material.tension.weft, 5);
  EXPECT_EQ(cloth.garment->panel("b").sheet.material.tension.weft, 7);
  ASSERT_EQ(cloth.ode.pins.size(), 4);
  for (const solver::Pin& pin : cloth.ode.pins) EXPECT_NEAR(cloth.start.x(pin.particle, 0), 0.3, rounding);
  EXPECT_EQ(model::size(scene), 0.6);
  const Scene again = model::parse_scene(model::to_toml(scene), "again");
  EXPECT_EQ(model::to_toml(again), model::to_toml(scene));
  EXPECT_EQ(model::compile(again).start.x, cloth.start.x);
}

/// One line that begins so.
struct Refused {
  std::string lines, says;
};

TEST(GarmentFiles, ThatAreWrongAreRefused) {
  const auto seam = [](const std::string& one, const std::string& other, const std::string& more = "") {
    return fmt::format("seams = [{{one = {{{}}}, other = {{{}}}{}}}]", one, other, more);
  };
  for (const auto& [lines, says] : std::vector<Refused>{
           {seam("panel = 'a', side = 'right'", "panel = 'collar', side = 'left'"),
            "a.toml: seams[0]: unknown panel 'collar': expected one of a, b"},
           {seam("panel = 'a', side = 'right'", "panel = 'b', side = 'lower', ends = [0, 2]"),
            "a.toml: seams[0]: expected as many particles on a right as on b lower, not 4 and 3"},
           {seam("panel = 'a', side = 'right'", "panel = 'b', side = 'lower'"),
            "a.toml: seams[0]: expected lengths that differ by 2 % at most (ease = 0.02), a right has 0.6 m and b lower 0.3 m"},
           {seam("panel = 'a', side = 'right'", "panel = 'b', side = 'left', ends = [0, 4]"),
            "a.toml: seams[0]: expected ends below 4, the particles on b left, not 0 and 4"},
           {seam("panel = 'a', side = 'right', ends = [0, 2]", "panel = 'a', side = 'right', ends = [1, 3]"),
            "a.toml: seams: expected to join no neighbours, 2 and 5 of a would be one"},
           {"panels = [{name = 'a', grid.n = 5, grid.cut = [{ line = [[0.3, -1], [3, -1]] }, { line = [[3, -1], [3, 3]] }, { "
            "line = [[3, 3], [0.3, 3]] }, "
            "{ line = [[0.3, 3], [0.3, -1]] }]}, {name = 'b', grid.n = 5}]\nseams = [{one = {panel = 'a', side = 'left'}, "
            "other = {panel = 'b', side = 'left'}}]",
            "a.toml: seams[0]: expected cloth on all of a left"},
           {seam("panel = 'a', side = 'top'", "panel = 'b', side = 'left'"),
            "a.toml:4: seams.one.side = 'top': expected one of \"lower\", \"right\", \"upper\", \"left\""},
           {seam("panel = 'a'", "panel = 'b', side = 'left'"), "a.toml:4: seams.one = "},
           {seam("panel = 'a', side = 'right'", "panel = 'b', side = 'left'", ", ease = -1"),
            "a.toml:4: seams.ease = -1: expected a number of at least 0"},
           {"pins = [{where = 'left edge'}]", "a.toml:4: pins = { where = 'left edge' }: expected 'panel' in every pin"},
           {"pins = [{panel = 'c', where = 'left edge'}]", "a.toml:4: pins.panel = 'c': expected one of \"a\", \"b\""},
           {"trim.file = 'nothing.obj'", "a.toml:4: trim.file = 'nothing.obj': "},
       }) {
    try {
      model::parse_scene(lines.starts_with("panels") ? "name = 'cut'\n" + lines : two_panels + lines, "a.toml");
      FAIL() << lines;
    } catch (const model::SceneError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(says));
    }
  }
  for (const auto& [lines, says] : std::vector<Refused>{
           {"panels = [{grid.n = 3}]", "a.toml:2: panels = { grid = { n = 3 } }: expected 'name' in every panel"},
           {"panels = [{name = 'a', pins = 3}]", "a.toml:2: panels.pins = 3: expected no such key; a panel has name"},
           {"panels = [{name = 'a', grid.m = 3}]",
            "a.toml:2: panels.grid.m = 3: expected no such key; a section grid has n, size"},
           {"panels = [{name = 'a', grid.n = 0}]", "a.toml:2: panels.grid.n = 0: expected a whole number"},
           {"panels = [{name = 'a'}, {name = 'a'}]", "a.toml:2: panels = { name = 'a' }: expected names that differ"},
           {"panels = [{name = 'a', start.wrap = 1}]", "a.toml: panel 'a': start.wrap: expected start.plane = \"vertical\""},
           {"seams = [{one = {panel = 'a', side = 'left'}, other = {panel = 'a', side = 'right'}}]",
            "a.toml: seams: expected panels, which they join"},
           {"pins = [{panel = 'a', where = 'left edge'}]",
            "a.toml:2: pins.panel = 'a': expected no panel, the scene has one sheet"},
       }) {
    try {
      model::parse_scene("name = 'bad'\n" + lines, "a.toml");
      FAIL() << lines;
    } catch (const model::SceneError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(says));
    }
  }
}

/// The thesis has 1310, 4998 and 5759: trousers of four equal panels have an odd number, as they have one crotch, and a sweater
/// has what numbers of cells on its seams allow.
TEST(BuiltinGarments, HaveAsManyParticlesAsThoseOfTheThesisAndBeginOutside) {
  for (const auto& [name, sewn] : {std::pair("dress", 1310), {"walking_dress", 1310}, {"trousers", 4999}, {"sweater", 5778}}) {
    model::Scene scene = model::load_scene(name);
    const model::Cloth cloth = model::compile(scene);
    EXPECT_GE(cloth.contacts->distances(0, cloth.start.x).minCoeff(), scene.contact.distance) << name;
    scene.phases.clear();
    EXPECT_EQ(model::nodes(scene), sewn) << name;
  }
}

}  // namespace
}  // namespace drape::verify::garment_test
