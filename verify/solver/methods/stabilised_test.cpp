// Stabilised explicit methods on a damped sheet: stable from the number of stages on that the closed form says.

#include "solver/methods/stabilised.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "solver/stability.hpp"

namespace drape::verify::stabilised_test {
namespace {

using solver::Integrator;
using solver::Method;
using solver::Outcome;
using solver::Step;

constexpr double h = 0.01;  // [s]

/// hung-corners with the thesis' damping of 50 kg/s, at the start.
model::Cloth damped_sheet() { return model::compile(model::load_scene("hung-corners")); }

double decay() {
  const model::Cloth cloth = damped_sheet();
  return solver::spectrum(cloth.ode, 0, cloth.start).decay / solver::spectrum_safety;
}

/// How fast the sheet moves after some steps of 0.01 s [m/s]; infinite if that is more than can be.
double speed(const char* name, void (*step)(Step&), int steps) {
  Method method = solver::method(name);
  method.step = step;
  const model::Cloth cloth = damped_sheet();
  Integrator integrator(cloth.ode, method, {}, cloth.start);
  for (int n = 0; n < steps; ++n)
    if (integrator.step(h).outcome != Outcome::success) return INFINITY;
  return integrator.state().v.rowwise().norm().maxCoeff();
}

TEST(Stages, AreTheFewestWithinTheBound) {
  for (const double z : {0.0, 0.5, 2.0, 2.1, 10.0, 2210.0, 2211.0, 1e6}) {
    const double l = solver::rkl2_stages(z), c = solver::rkc2_stages(z), factor = 1 - 2 * solver::rkc2_damping / 15;
    EXPECT_GE((l * l + l - 2) / 2, z);
    EXPECT_TRUE(l == 2 || ((l - 1) * (l - 1) + (l - 1) - 2) / 2 < z) << z;
    EXPECT_GE(2.0 / 3 * (c * c - 1) * factor, z * (1 - 1e-12));
    EXPECT_TRUE(c == 2 || 2.0 / 3 * ((c - 1) * (c - 1) - 1) * factor < z) << z;
  }
}

TEST(Rkl2, IsStableOnASheetFrom67StagesOn) {
  EXPECT_EQ(solver::rkl2_stages(h * decay()), 67);
  EXPECT_LE(speed(
                "rkl2", [](Step& s) { rkl2(s, 67); }, 100),
            100);
  EXPECT_GE(speed(
                "rkl2", [](Step& s) { rkl2(s, 60); }, 100),
            1e3);
}

TEST(Rkc2, IsStableOnASheetFrom59StagesOn) {
  EXPECT_EQ(solver::rkc2_stages(h * decay()), 59);
  EXPECT_LE(speed(
                "rkc2", [](Step& s) { rkc2(s, 59); }, 100),
            100);
  EXPECT_GE(speed(
                "rkc2", [](Step& s) { rkc2(s, 53); }, 100),
            1e3);
}

}  // namespace
}  // namespace drape::verify::stabilised_test
