// Sheets that rest curved: what is at rest, what it takes to unroll them, and that they return.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "model/sheet/strain.hpp"
#include "solver/integrator.hpp"
#include "verify/support/model_fixtures.hpp"

namespace drape::verify::rest_curvature_test {
namespace {

using namespace sheets;
using model::BendForm;
using testing::ElementsAre;
using testing::IsEmpty;

Material material() {
  Material m;
  m.density = 0.2;
  m.tension = {100, 100};
  m.shear = 5;
  m.bend = {1e-3, 2e-3};
  return m;
}

Scene pleated(BendForm form, bool projected) {
  Scene scene;
  scene.sheet.grid = {.nu = 17, .nv = 5, .size_u = 0.4, .size_v = 0.1};
  scene.sheet.material = material();
  scene.sheet.material.bend_form = form;
  scene.sheet.material.bend_projected = projected;
  scene.start.pleats = {.count = 2, .degrees = 50};
  scene.rest = model::RestShape::start;
  return scene;
}

TEST(RestCurvature, HoldsPleatsWithoutForce) {
  for (const auto& [form, projected] :
       {std::pair{BendForm::plate, false}, {BendForm::plate, true}, {BendForm::membrane, true}}) {
    Scene scene = pleated(form, projected);
    const model::Cloth resting = model::compile(scene);
    scene.rest = model::RestShape::flat;
    const model::Cloth flat = model::compile(scene);
    const double size = largest(evaluate(flat.ode.force, {flat.start.x, at_rest(flat.start.x)}));
    EXPECT_GT(size, 1e-6);
    EXPECT_LT(largest(evaluate(resting.ode.force, {resting.start.x, at_rest(resting.start.x)})), 1e-9 * size);
    if (!projected) {
      EXPECT_NEAR(resting.ode.potential_energy(0, resting.start.x), 0, 1e-14);
    }
  }
}

Scene curled(double kappa) {
  Scene scene;
  scene.sheet.grid = {.nu = 9, .nv = 4, .size_u = 0.2, .size_v = 0.1};
  scene.sheet.material = material();
  scene.sheet.material.bend_damping = {1e-5, 1e-5};
  scene.sheet.material.bend_projected = false;
  scene.sheet.rest = cylinder(scene.sheet.grid, kappa);
  return scene;
}

/// ½ B/R² by area.
TEST(RestCurvature, MakesUnrollingCostEnergy) {
  constexpr double kappa = 8;
  const Scene scene = curled(kappa);
  const model::Cloth cloth = model::compile(scene);
  const Grid& grid = scene.sheet.grid;
  const double area = grid.size_v * (grid.size_u - grid.spacing_u());  // of the particles that know a curvature
  EXPECT_NEAR(cloth.ode.potential_energy(0, grid.parameters()), 0.5 * 1e-3 * kappa * kappa * area, 1e-12);
  EXPECT_NEAR(cloth.ode.potential_energy(0, scene.sheet.rest), 0, 1e-14);
}

TEST(RestCurvature, IsWhatAFlatSheetReturnsTo) {
  constexpr double kappa = 8;
  const Scene scene = curled(kappa);
  const model::Cloth cloth = model::compile(scene);
  State start = cloth.start;
  start.x.col(2) = 1e-3 * start.x.col(0);
  solver::Integrator integrator(cloth.ode, solver::method("implicit-euler"), {}, start);
  ASSERT_EQ(integrate(integrator, 2, 0.01).outcome, solver::Outcome::success);
  for (int a = 1; a < 8; ++a)
    EXPECT_NEAR(model::Strain::of_curvature(model::Metric(scene.sheet.grid), a, 2, true).value(integrator.state().x), kappa,
                1e-3);
  EXPECT_LT(solver::stored_energy(cloth.ode, 0, integrator.state()), 1e-7);
}

TEST(RestCurvature, HasTheForceAndTheJacobianOfItsEnergy) {
  constexpr double step = 1e-6;
  const State y = deformed(five_by_four(), 1);
  Scene scene = curled(8);
  scene.sheet.grid = five_by_four();
  scene.sheet.rest = cylinder(scene.sheet.grid, 3);
  scene.sheet.material.bend_damping = {};
  const SplitOde ode = model::compile(scene).ode;
  SparseMatrix dx, dv;
  ode.jacobian(0, y.x, at_rest(y.x), dx, dv);
  const Vectors f = evaluate(ode.force, {y.x, at_rest(y.x)});
  for (int i = 0; i < y.x.size(); ++i) {
    Vectors above = y.x, below = y.x;
    above.data()[i] += step, below.data()[i] -= step;
    EXPECT_NEAR(-(ode.potential_energy(0, above) - ode.potential_energy(0, below)) / (2 * step), f.data()[i],
                1e-6 * largest(f));
    const Vectors column =
        (evaluate(ode.force, {above, at_rest(y.x)}) - evaluate(ode.force, {below, at_rest(y.x)})) / (2 * step);
    Vectors exact(y.x.rows(), 3);
    Eigen::VectorXd::Map(exact.data(), exact.size()) = Eigen::VectorXd(dx.col(i));
    EXPECT_LT((column - exact).norm(), 1e-5 * largest(dx)) << i;
  }
}

/// It has an energy, but no force between two states that keeps it.
TEST(RestCurvature, IsNotForMethodsThatNeedMeanForces) {
  Scene scene = scene_of(force_case("unprojected_plate"), five_by_four());
  EXPECT_THAT(model::compile(scene).ode.without_energy, IsEmpty());
  scene.sheet.rest = cylinder(scene.sheet.grid, 3);
  EXPECT_THAT(model::compile(scene).ode.without_energy, ElementsAre("rest-curvature"));
}

TEST(RestCurvature, IsAKeyOfAScene) {
  const Scene scene = model::parse_scene("name = 'x'\nrest.shape = 'start'\nstart.pleats = [1, 30]\ngrid.n = 9", "a.toml");
  EXPECT_EQ(scene.rest, model::RestShape::start);
  EXPECT_EQ(to_toml(model::parse_scene(to_toml(scene), "b.toml")), to_toml(scene));
}

}  // namespace
}  // namespace drape::verify::rest_curvature_test
