// Every force alone against the continuum on a moving surface: the virtual work of the forces of a sheet with the load that was
// generated is that of the inertia, up to second order, borders, corners and viscous parts included. This holds for all of
// them, also for those that alone have no well-posed motion: shear and contraction are indefinite without tension.

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "verify/support/convergence.hpp"
#include "verify/support/manufactured_sheets.hpp"

namespace drape::verify::manufactured_work_test {
namespace {

using namespace manufactured;

constexpr int refinements[] = {6, 8, 11, 15};

/// Nine smooth fields at the nodes, N × 9, that vanish on borders that are not free.
Eigen::MatrixXd fields(const Grid& grid, const Motion& motion) {
  const auto arch = [](double u, double v) { return basis(2, size_u)(u) * basis(2, size_v)(v); };
  Eigen::MatrixXd phi(grid.particles(), 9);
  const Vectors places = grid.parameters();
  for (int i = 0; i < grid.particles(); ++i)
    for (int k = 0; k < 9; ++k) {
      const double u = places(i, 0), v = places(i, 1);
      phi(i, k) = basis(k / 3, size_u)(u) * basis(k % 3, size_v)(v) * (motion.free ? 1 : arch(u, v));
    }
  return phi;
}

/// Σ (f − m a) φ over the particles: the norm over all fields φ and directions [J].
double work(const Problem& problem, const Grid& grid, const Motion& motion) {
  const auto [x, v, z] = problem.start;
  Vectors rest(x.rows(), 3);
  problem.ode.force(start_time, x, v, rest);
  const Nodes nodes(grid, surface(motion));
  for (int i = 0; i < grid.particles(); ++i) rest.row(i) -= problem.ode.mass[i] * nodes.jet(i, start_time).acceleration;
  return (fields(grid, motion).transpose() * rest).norm();
}

/// How the work that is left over falls on finer grids. `build` makes the sheet on a grid.
template <class Build>
Convergence convergence(const Motion& motion, const Build& build) {
  Convergence measured;
  for (const int k : refinements) {
    measured.steps.push_back(1.0 / k);
    measured.errors.push_back(work(build(grid(k)), grid(k), motion));
  }
  return measured;
}

/// Whether a sheet made of one force has any in this motion: viscous ones need a motion, bending along the normal a curvature.
bool acts(const std::string& force, const Motion& motion) {
  const Material m = force_case(force).material;
  const bool along_normal = m.bend.any() && (m.bend_form == BendForm::membrane || m.bend_projected) && !m.tension.any();
  const bool viscous = m.damping.any() && !m.tension.any();
  return (motion.moving || !viscous) && (motion.curved || !along_normal);
}

using Case = std::tuple<std::string, Motion>;

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const ForceCase& force : force_cases())
    for (const Motion& motion : motions()) {
      const bool consistent = force.material.shear_form == ShearForm::conservative &&
                              force.material.bend_form < BendForm::printed && force.gravity.isZero() && !force.wind.blows() &&
                              force.air == 0 && !ode_of(force, five_by_four()).memory &&
                              !by_tables(force.material);  // the continuum is linear
      if (consistent && acts(force.name, motion)) all.emplace_back(force.name, motion);
    }
  for (const Motion& motion : motions())
    for (const char* name : {"all_of_the_thesis", "all_with_energies", "all_with_a_membrane"}) all.emplace_back(name, motion);
  return all;
}

/// The thesis' shear as printed is not consistent on borders; the conservative form stands in for it here.
Material material_of(const std::string& force) {
  Material m = force_case(force).material;
  m.shear_form = ShearForm::conservative;
  return m;
}

class ManufacturedWork : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(, ManufacturedWork, testing::ValuesIn(cases()),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param).name(); });

TEST_P(ManufacturedWork, OfForcesAndLoadsIsThatOfInertiaAtSecondOrder) {
  const Material material = material_of(std::get<0>(GetParam()));
  const Motion& motion = std::get<1>(GetParam());
  EXPECT_TRUE(has_order(convergence(motion, [&](const Grid& mesh) { return loaded(mesh, material, motion); }), 2));
}

// Negative controls: what the check above must reject.

const Motion general{.curved = true, .free = true, .moving = true};
const Material everything = material_of("all_of_the_thesis");

TEST(ManufacturedWorkCheck, RejectsWeftAndWarpInEachOthersPlace) {
  const auto rejects = [](auto modulus) {
    reference::ContinuumMaterial swapped = continuum(everything);
    std::swap((swapped.*modulus).u, (swapped.*modulus).v);
    return !has_order(convergence(general, [&](const Grid& mesh) { return loaded(mesh, everything, general, swapped); }), 2);
  };
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::tension));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::linear_damping));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::bend));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::bend_damping));
}

TEST(ManufacturedWorkCheck, RejectsModuliThatAreATenthOff) {
  const auto rejects = [](auto modulus) {
    reference::ContinuumMaterial other = continuum(everything);
    other.*modulus *= 1.1;
    return !has_order(convergence(general, [&](const Grid& mesh) { return loaded(mesh, everything, general, other); }), 2);
  };
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::shear));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::shear_damping));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::contraction));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::contraction_damping));
  EXPECT_TRUE(rejects(&reference::ContinuumMaterial::density));
}

testing::AssertionResult has_second_order_with(Load::CellOf cell) {
  return has_order(
      convergence(general, [&](const Grid& mesh) { return loaded(mesh, everything, general, continuum(everything), cell); }),
      2);
}

TEST(ManufacturedWorkCheck, RejectsAMissingTraction) {
  EXPECT_TRUE(has_second_order_with(dual_cell));
  EXPECT_FALSE(has_second_order_with(no_traction_on_the_right));
}

TEST(ManufacturedWorkCheck, RejectsWholeCellsOnBorders) {
  EXPECT_FALSE(has_second_order_with([](const Grid& mesh, int a, int b) {
    reference::DualCell cell = dual_cell(mesh, a, b);
    cell.width_v = mesh.spacing_v();
    return cell;
  }));
}

}  // namespace
}  // namespace drape::verify::manufactured_work_test
