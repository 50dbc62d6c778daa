// What manufactured solutions are made of: derivatives, the divergence that automatic differentiation finds, the load of a
// node.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "verify/support/manufactured_sheets.hpp"

namespace drape::verify::manufactured_continuum_test {
namespace {

using namespace manufactured;
using reference::ContinuumMaterial;
using reference::Jet;
using reference::MovingJet;

/// f'(0) of f by differences of fourth order.
template <class F>
auto slope(const F& f, double h) {
  return ((8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)).eval();
}

const Motion general{.curved = true, .free = true, .moving = true};
const Surface moving_surface = surface(general);
const double u = 0.37, v = 0.21, t = 0.83;

MovingJet jet_at(double at_u, double at_v, double at_t) { return SurfacePoint(moving_surface, at_u, at_v).at(at_t); }

/// Everything at once, with both forms of damping, and without inertia or bending.
ContinuumMaterial all_stresses() {
  ContinuumMaterial m = continuum(made_of(tension, linear_damping, shear, contraction));
  m.projected_damping = {0.35, 0.25};
  m.density = 0;
  return m;
}

TEST(ManufacturedSurface, HasTheDerivativesOfItsPositions) {
  const double h = 1e-3;
  const MovingJet jet = jet_at(u, v, t);
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; i + j <= 4; ++j) {
      const auto lower_u = [&](double d) -> Vector3d { return jet_at(u + d, v, t).s(i - 1, j); };
      const auto lower_v = [&](double d) -> Vector3d { return jet_at(u, v + d, t).s(i, j - 1); };
      const auto in_time = [&](double d) -> Vector3d { return jet_at(u, v, t + d).s(i, j); };
      EXPECT_LE(i == 0 ? 0 : largest(slope(lower_u, h) - jet.s(i, j)), 1e-7) << i << j;
      EXPECT_LE(j == 0 ? 0 : largest(slope(lower_v, h) - jet.s(i, j)), 1e-7) << i << j;
      EXPECT_LE(largest(slope(in_time, h) - jet.rate(i, j)), 1e-7) << i << j;
    }
  const auto velocity = [&](double d) -> Vector3d { return jet_at(u, v, t + d).rate(0, 0); };
  EXPECT_LE(largest(slope(velocity, h) - jet.acceleration), 1e-7);
}

TEST(ManufacturedSurface, IsStretchedEverywhereAndHasNoMomentOnBorders) {
  for (const Motion& motion : motions())
    for (const double time : {start_time, start_time + 0.4, start_time + 0.8})
      for (double x = 0; x <= 1; x += 0.125)
        for (double y = 0; y <= 1; y += 0.125) {
          const Jet s = SurfacePoint(surface(motion), x * size_u, y * size_v).at(time).s;
          EXPECT_GT(s(1, 0).norm(), 1.04) << motion.name() << " at " << x << ", " << y;
          EXPECT_GT(s(0, 1).norm(), 1.04) << motion.name() << " at " << x << ", " << y;
          EXPECT_LE(x == 0 || x == 1 ? largest(s(2, 0)) : 0, 1e-14) << motion.name();
          EXPECT_LE(y == 0 || y == 1 ? largest(s(0, 2)) : 0, 1e-14) << motion.name();
        }
}

TEST(ManufacturedSurface, MovesBordersThatAreNotFreeWithConstantVelocity) {
  const Surface fixed = surface({.curved = true, .free = false, .moving = true});
  for (const double place : {0.0, 0.3, 1.0})
    for (const auto& [x, y] : {std::pair(place, 0.0), {place, 1.0}, {0.0, place}, {1.0, place}}) {
      const MovingJet jet = SurfacePoint(fixed, x * size_u, y * size_v).at(t);
      EXPECT_LE(largest(jet.acceleration), 1e-14);
      EXPECT_GE(largest(jet.rate(0, 0)), 0.1);
    }
}

TEST(ManufacturedLoad, HasTheDivergenceOfTheStress) {
  const ContinuumMaterial m = all_stresses();
  const auto p_u = [&](double d) -> Vector3d { return stress(m, jet_at(u + d, v, t)).p_u; };
  const auto p_v = [&](double d) -> Vector3d { return stress(m, jet_at(u, v + d, t)).p_v; };
  const Vector3d divergence = slope(p_u, 1e-3) + slope(p_v, 1e-3);
  EXPECT_GT(divergence.norm(), 1);
  EXPECT_LE(largest(body_force(m, jet_at(u, v, t)) + divergence), 1e-8);
}

TEST(ManufacturedLoad, BalancesItselfButForInertia) {
  // Stresses and bending are inner forces: with tractions, edge and corner forces, all loads on a free sheet sum to zero.
  ContinuumMaterial m = all_stresses();
  m.bend = {0.06, 0.04};
  m.bend_damping = {0.01, 0.02};
  m.bending = reference::Bending::plate;
  const auto sum_on = [&](int k) {
    const Grid mesh = grid(k);
    const Nodes nodes(mesh, moving_surface);
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < mesh.particles(); ++i) {
      const auto [force, bending] = node_load(m, nodes.jet(i, t), dual_cell(mesh, i % mesh.nu, i / mesh.nu));
      sum += force + bending;
    }
    return sum;
  };
  EXPECT_LE(largest(sum_on(16)), 0.01);
  EXPECT_LE(largest(4 * sum_on(16) - sum_on(8)), 0.05 * largest(sum_on(8)));  // the error of the trapezoidal rule
}

TEST(ManufacturedLoad, IsAlongTheNormalForWhatBendsAlongIt) {
  for (const auto bending : {reference::Bending::membrane, reference::Bending::projected_plate}) {
    ContinuumMaterial m;
    m.density = 0;
    m.bend = {0.6, 0.4};
    m.bending = bending;
    const MovingJet jet = jet_at(u, v, t);
    const Vector3d b = body_force(m, jet);
    EXPECT_GT(b.norm(), 0.1);
    EXPECT_LE(b.cross(jet.s(1, 0).cross(jet.s(0, 1))).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace drape::verify::manufactured_continuum_test
