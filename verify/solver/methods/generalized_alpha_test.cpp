// Fast modes are multiplied by the spectral radius that a method of the alpha family is named or chosen for, slow ones by 1.

#include <gtest/gtest.h>

#include <cmath>

#include "reference/theory/amplification.hpp"

namespace drape::verify::generalized_alpha_test {
namespace {

struct Radius {
  const char* method;
  double at_infinity;
};
constexpr Radius radii[] = {{"generalized-alpha", 0.8}, {"generalized-alpha-0.5", 0.5}, {"newmark", 1}, {"hht", 0.9 / 1.1}};

double radius(const char* method, double W) { return reference::spectral_radius(solver::method(method), {W, W, 0}); }

TEST(GeneralizedAlpha, MultipliesFastModesByItsRadius) {
  for (const auto& [method, at_infinity] : radii) EXPECT_NEAR(radius(method, 1e8), at_infinity, 1e-2) << method;
}

/// What a step takes from slow modes is of fourth order in h ω.
TEST(GeneralizedAlpha, KeepsSlowModes) {
  for (const auto& [method, at_infinity] : radii) {
    const double lost = 1 - radius(method, 1e-2), lost_of_half = 1 - radius(method, 1e-2 / 4);
    EXPECT_LE(lost, 1e-3) << method;
    EXPECT_GE(lost, at_infinity == 1 ? -1e-12 : 5e-8) << method;
    if (at_infinity == 1) continue;
    EXPECT_NEAR(std::log2(lost / lost_of_half), 4, 0.1) << method;
  }
}

}  // namespace
}  // namespace drape::verify::generalized_alpha_test
