// The stability limit of methods that divide their steps follows the state: it is estimated again where modes leave it, and
// nowhere else.

#include <gtest/gtest.h>

#include <cmath>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "solver/stability.hpp"

namespace drape::verify::verlet_limit_test {
namespace {

using model::Cloth;
using model::Scene;
using solver::Integrator;
using solver::Outcome;

/// Soft threads and stiff shear, which gets stiffer with the square of the stretch: its limit at the start is too wide soon.
Scene pulled_askew() {
  Scene scene = model::load_scene("hung-corners");
  scene.sheet.grid = {.nu = 10, .nv = 10, .size_u = 1, .size_v = 1};
  scene.sheet.gravity.setZero();
  scene.sheet.material = {};
  scene.sheet.material.tension = {10, 10};
  scene.sheet.material.shear = 1000;
  scene.pins = {{.where = "left edge", .particles = {}}, {.where = "right edge", .particles = {}, .velocity = {1, 2, 0}}};
  return scene;
}

TEST(SubSteps, FollowASheetThatIsPulledAskew) {
  const Scene scene = pulled_askew();
  const Cloth same = model::compile(scene);
  Integrator fine(same.ode, solver::method("esdirk4"), {}, same.start);
  ASSERT_EQ(integrate(fine, 0.5, 0.001).outcome, Outcome::success);
  for (const char* method : {"verlet", "rk4-substeps", "bridson"}) {
    const Cloth cloth = model::compile(scene);
    Integrator integrator(cloth.ode, solver::method(method), {}, cloth.start);
    ASSERT_EQ(integrate(integrator, 0.5, 0.01).outcome, Outcome::success) << method;
    EXPECT_LE((integrator.state().x - fine.state().x).rowwise().norm().maxCoeff(), 1e-2) << method;
    EXPECT_GT(cloth.ode.work->count("stability_limits"), 1) << method;
    EXPECT_LT(cloth.ode.work->count("stability_limits"), 100) << method;
  }
}

TEST(VerletLimit, IsEstimatedOnceWhereItHolds) {
  Scene scene = model::load_scene("hung-corners");
  scene.sheet.material.damping = {0.5, 0.5};
  const Cloth cloth = model::compile(scene), same = model::compile(scene);
  const double limit = solver::verlet_limit(solver::spectrum(same.ode, 0, same.start));
  Integrator integrator(cloth.ode, solver::method("verlet"), {}, cloth.start);
  ASSERT_EQ(integrate(integrator, 0.5, 0.1).outcome, Outcome::success);
  const std::int64_t substeps = 5 * std::lround(std::ceil(0.1 / (0.9 * limit)));
  EXPECT_EQ(cloth.ode.work->count("stability_limits"), 1);
  EXPECT_EQ(cloth.ode.work->count("substeps"), substeps) << "as many as the limit of the start asks for";
  EXPECT_EQ(cloth.ode.work->count("forces"), substeps + 1 + same.ode.work->count("forces"));
}

}  // namespace
}  // namespace drape::verify::verlet_limit_test
