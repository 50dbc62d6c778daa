// The hanging and the swinging chain: closed forms of the chain are exact for the model's masses and springs, and come to the
// closed forms of the continuum with second order.

#include <gtest/gtest.h>

#include <cmath>

#include "model/cloth.hpp"
#include "reference/exact/chain.hpp"
#include "reference/exact/tension.hpp"
#include "verify/support/convergence.hpp"

namespace drape::verify::exact_chain_test {
namespace {

using reference::ChainWave;
using reference::HangingChain;

const HangingChain chain{.modulus = 20};  // strains of a quarter
const ChainWave wave{.mode = 3};

/// A chain along x whose ends are held.
model::Scene scene_of(int springs, double length, double modulus) {
  model::Scene scene;
  scene.sheet.grid = {springs + 1, 1, length, 0.05};
  scene.sheet.material.tension = {modulus, modulus};
  scene.pins = {{.where = "left edge", .particles = {}}, {.where = "right edge", .particles = {}}};
  return scene;
}

/// Without the pinned ones.
solver::Vectors forces(const model::Scene& scene, const solver::Vectors& x) {
  const solver::SplitOde ode = model::compile(scene).ode;
  solver::Vectors f(x.rows(), 3);
  ode.force(0, x, 0 * x, f);
  solver::filter(ode.pins, f);
  return f;
}

TEST(HangingChain, MassesAreInEquilibrium) {
  for (const int springs : {2, 7, 20}) {
    model::Scene scene = scene_of(springs, chain.length, chain.modulus);
    scene.sheet.gravity[2] = -chain.body_force;
    const Eigen::MatrixX2d nodes = reference::hanging_masses(chain, springs);
    solver::Vectors x = scene.sheet.grid.parameters();
    x.col(0) = nodes.col(0);
    x.col(2) = nodes.col(1);
    EXPECT_NEAR(x(springs, 0), chain.span, 1e-14);
    EXPECT_NEAR(x(springs, 2), 0, 1e-14);
    EXPECT_LE(forces(scene, x).cwiseAbs().maxCoeff(), 1e-10 * chain.body_force) << springs;
  }
}

TEST(HangingChain, MassesComeToTheContinuumWithSecondOrder) {
  Convergence c;
  for (const int springs : {8, 16, 32, 64}) {
    const Eigen::MatrixX2d nodes = reference::hanging_masses(chain, springs);
    double sum = 0;
    for (int j = 0; j <= springs; ++j)
      sum += (nodes.row(j).transpose() - reference::hanging_position(chain, chain.length * j / springs)).squaredNorm();
    c.steps.push_back(chain.length / springs);
    c.errors.push_back(std::sqrt(sum / springs));
  }
  EXPECT_TRUE(has_order(c, 2));
}

/// (2.11) at rest, the derivatives by central differences.
TEST(HangingChain, ContinuumFulfilsItsEquation) {
  constexpr double h = 1e-3;
  const auto s = [](double X) { return reference::hanging_position(chain, X); };
  const auto force = [&](double X) -> Eigen::Vector2d {
    const Eigen::Vector2d ds = (s(X + h / 2) - s(X - h / 2)) / h;
    return chain.modulus * (1 - 1 / ds.norm()) * ds;
  };
  for (const double X : {0.1, 0.35, 0.5, 0.8}) {
    const Eigen::Vector2d residual = (force(X + h / 2) - force(X - h / 2)) / h - Eigen::Vector2d(0, chain.body_force);
    EXPECT_LE(residual.norm(), 1e-4 * chain.body_force) << X;
  }
  EXPECT_LE(s(0).norm(), 1e-15);
  EXPECT_LE((s(chain.length) - Eigen::Vector2d(chain.span, 0)).norm(), 1e-14);
}

TEST(HangingChain, FoldedInHalfIsTwoPulledStrips) {
  HangingChain folded = chain;
  folded.span = 1e-9;
  const double half = chain.length / 2;
  const double depth = reference::pulled_position({half, chain.modulus, chain.body_force}, half);
  EXPECT_NEAR(reference::hanging_position(folded, half)[1], -depth, 1e-8);
}

TEST(ChainWave, IsAnExactMotionOfTheMasses) {
  constexpr double t = 0.123;
  for (const int springs : {4, 7, 20}) {
    const model::Scene scene = scene_of(springs, wave.length, wave.modulus);
    const Eigen::VectorXd mass = model::compile(scene).ode.mass;
    const double omega = reference::wave_frequency(wave, springs);
    solver::Vectors x = scene.sheet.grid.parameters();
    const Eigen::VectorXd X = x.col(0);
    for (int i = 0; i <= springs; ++i) x(i, 0) = reference::wave_position(wave, omega, X[i], t);
    const solver::Vectors f = forces(scene, x);
    for (int i = 1; i < springs; ++i) EXPECT_NEAR(f(i, 0), -mass[i] * omega * omega * (x(i, 0) - X[i]), 1e-11) << i;
  }
}

TEST(ChainWave, SwingsSlowerThanTheContinuumBySecondOrder) {
  Convergence c;
  for (const int springs : {16, 32, 64, 128}) {
    c.steps.push_back(wave.length / springs);
    c.errors.push_back(reference::wave_frequency(wave) - reference::wave_frequency(wave, springs));
  }
  EXPECT_TRUE(has_order(c, 2));
}

/// ρ ü = k u'' by central differences.
TEST(ChainWave, ContinuumFulfilsTheWaveEquation) {
  constexpr double h = 1e-3, X = 0.4, t = 0.01;
  const double omega = reference::wave_frequency(wave), c = std::sqrt(wave.modulus / wave.density);
  const auto x = [&](double at, double time) { return reference::wave_position(wave, omega, at, time); };
  const double in_time = (x(X, t + h / c) - 2 * x(X, t) + x(X, t - h / c)) / (h * h);
  const double in_space = (x(X + h, t) - 2 * x(X, t) + x(X - h, t)) / (h * h);
  EXPECT_GE(std::abs(in_space), 0.1);
  EXPECT_NEAR(in_time, in_space, 1e-6);
}

}  // namespace
}  // namespace drape::verify::exact_chain_test
