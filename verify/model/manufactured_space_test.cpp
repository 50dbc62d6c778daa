// Order in space: sheets follow a surface that was chosen beforehand, with the load that the continuum says is missing, and the
// distance from it falls at second order. Time steps are so small that their errors do not show.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/integrator.hpp"
#include "verify/support/convergence.hpp"
#include "verify/support/manufactured_materials.hpp"
#include "verify/support/manufactured_sheets.hpp"

namespace drape::verify::manufactured_space_test {
namespace {

using namespace manufactured;

constexpr int refinements[] = {3, 4, 5, 6};
constexpr double duration = 0.6;  // [s]: a wave of tension crosses the sheet, the swing covers a good third of its period
constexpr int steps = 120;

/// Distance from the surface at the end [m].
double error(const Problem& problem) {
  solver::Integrator integrator(problem.ode, solver::method("verlet"), {}, problem.start, start_time);
  const auto run = integrate(integrator, start_time + duration, duration / steps);
  EXPECT_EQ(run.outcome, solver::Outcome::success) << run.message;
  return l2_norm(problem.ode, integrator.state().x - problem.exact(integrator.time()).x);
}

/// How the error falls on finer grids. `build` makes the sheet on a grid.
template <class Build>
Convergence convergence(const Build& build) {
  Convergence measured;
  for (const int k : refinements) {
    measured.steps.push_back(1.0 / k);
    measured.errors.push_back(error(build(grid(k))));
  }
  return measured;
}

/// Whether a sheet of this material has any force in this motion of its own.
bool acts(const NamedMaterial& named, const Motion& motion) {
  const std::string& name = named.name;
  if (name == "damping" || name == "projected_damping") return motion.moving;
  if (name == "membrane") return motion.curved && !motion.free;  // see ManufacturedMembrane below
  if (name == "membrane_with_tension" || name == "plate") return motion.curved;
  return true;
}

using Case = std::tuple<NamedMaterial, Motion>;

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const NamedMaterial& material : carried_materials())
    for (const Motion& motion : motions())
      if (acts(material, motion)) all.emplace_back(material, motion);
  return all;
}

class ManufacturedMotion : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(, ManufacturedMotion, testing::ValuesIn(cases()),
                         [](const auto& test) { return std::get<0>(test.param).name + "_" + std::get<1>(test.param).name(); });

TEST_P(ManufacturedMotion, IsFollowedAtSecondOrderInSpace) {
  const Material& material = std::get<0>(GetParam()).material;
  const Motion& motion = std::get<1>(GetParam());
  EXPECT_TRUE(has_order(convergence([&](const Grid& mesh) { return loaded(mesh, material, motion); }), 2));
}

TEST(ManufacturedMembrane, AloneDoesNotDetermineItsFreeBorders) {
  // Along the normal there is no traction: the difference of a border particle from its inner neighbour obeys no law but that
  // of their loads, and with the neighbour's curvature an error of its slope of (B/ρ) s_uuu grows on every grid.
  const Motion motion{.curved = true, .free = true, .moving = false};
  const Convergence measured = convergence([&](const Grid& mesh) { return loaded(mesh, made_of(soft_membrane), motion); });
  EXPECT_GT(measured.errors.back(), 0.6 * measured.errors.front());
}

// Negative controls: what the check above must reject.

const Motion general{.curved = true, .free = true, .moving = true};
const Material carried_shear = made_of(tension, soft_shear);

testing::AssertionResult has_second_order_with(const reference::ContinuumMaterial& other, Load::CellOf cell = dual_cell) {
  return has_order(convergence([&](const Grid& mesh) { return loaded(mesh, carried_shear, general, other, cell); }), 2);
}

TEST(ManufacturedMotionCheck, RejectsWeftAndWarpInEachOthersPlace) {
  reference::ContinuumMaterial swapped = continuum(carried_shear);
  std::swap(swapped.tension.u, swapped.tension.v);
  EXPECT_FALSE(has_second_order_with(swapped));
}

TEST(ManufacturedMotionCheck, RejectsAMissingTraction) {
  EXPECT_TRUE(has_second_order_with(continuum(carried_shear)));
  EXPECT_FALSE(has_second_order_with(continuum(carried_shear), no_traction_on_the_right));
}

TEST(ManufacturedMotionCheck, RejectsWholeMassesOnBorders) {
  EXPECT_FALSE(has_order(convergence([](const Grid& mesh) {
                           Problem problem = loaded(mesh, carried_shear, general);
                           problem.ode.mass.setConstant(problem.ode.mass.maxCoeff());
                           return problem;
                         }),
                         2));
}

}  // namespace
}  // namespace drape::verify::manufactured_space_test
