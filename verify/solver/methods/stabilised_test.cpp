// Stabilised explicit methods on a damped sheet: stable from the number of stages on that the closed form says.

#include <gtest/gtest.h>

#include <cmath>

#include "model/cloth.hpp"
#include "model/scene_file/scene_file.hpp"
#include "solver/integrator.hpp"
#include "solver/methods/rock2.hpp"
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

/// R of the steps that a method with these coefficients takes: an array of factors in, one of growths out; or for power series
/// in z, whose products are cut off.
template <class Number, class Product>
Number growth(const solver::Rock2Polynomial& polynomial, const Number& one, const Product& times_z) {
  Number before = 0 * one, last = one;
  for (const solver::StageWeights& w : polynomial.weights) {
    const Number next = w.mu * last + w.nu * before + w.mu_tilde * times_z(last);
    before = last;
    last = next;
  }
  return last + 2 * polynomial.sigma * times_z(last) + polynomial.tau * times_z(times_z(last));
}

double growth_at(const solver::Rock2Polynomial& polynomial, double z) {
  return growth(polynomial, 1.0, [z](double value) { return z * value; });
}

class Rock2Of : public testing::TestWithParam<int> {};

TEST_P(Rock2Of, HasThePolynomialThatItIsDefinedBy) {
  const int s = GetParam();
  const solver::Rock2Polynomial polynomial(s);
  const Eigen::Vector4d series = growth(polynomial, Eigen::Vector4d(1, 0, 0, 0),
                                        [](const Eigen::Vector4d& p) { return Eigen::Vector4d(0, p[0], p[1], p[2]); });
  EXPECT_NEAR(series[0], 1, 1e-12);
  EXPECT_NEAR(series[1], 1, 1e-12 * s);
  EXPECT_NEAR(series[2], 0.5, 1e-12 * s);
  EXPECT_NEAR(series[3], polynomial.third / 6, 1e-12 * s);
  double largest = 0;
  for (int k = 0; k <= 40 * s; ++k)
    largest = std::max(largest, std::abs(growth_at(polynomial, (std::cos(M_PI * k / (40 * s)) - polynomial.a) / polynomial.d)));
  EXPECT_NEAR(largest, 0.95, 1e-3) << "the ripple that is asked for";
  EXPECT_GT(std::abs(growth_at(polynomial, -1.01 * polynomial.interval())), 1);
}

TEST_P(Rock2Of, IsStableUpTo081TimesTheSquareOfTheStages) {
  const double s = GetParam(), interval = solver::Rock2Polynomial(GetParam()).interval();
  EXPECT_GE(interval, 0.807 * s * s - 1.145);
  EXPECT_LE(interval, 0.81 * s * s);
  EXPECT_EQ(solver::rock2_stages(0.807 * s * s - 1.145 - 1e-6 * s), s);
  EXPECT_EQ(solver::rock2_stages(0.807 * s * s - 1.145 + 1e-6 * s), s + 1);
}

INSTANTIATE_TEST_SUITE_P(Stages, Rock2Of, testing::Values(3, 4, 5, 6, 7, 8, 9, 10, 13, 17, 20, 31, 50, 99, 100, 200, 350, 500));

TEST(Rock2, IsStableOnASheetFrom53StagesOn) {
  const auto with = [](int stages) {
    static const solver::Rock2Polynomial polynomials[] = {solver::Rock2Polynomial(48), solver::Rock2Polynomial(53)};
    return stages == 48 ? [](Step& s) { rock2(s, polynomials[0]); } : [](Step& s) { rock2(s, polynomials[1]); };
  };
  EXPECT_EQ(solver::rock2_stages(h * decay()), 53);
  EXPECT_LE(speed("rock2", with(53), 100), 100);
  EXPECT_GE(speed("rock2", with(48), 100), 1e3);
}

}  // namespace
}  // namespace drape::verify::stabilised_test
