#include "verify/support/distance_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace drape::verify {

FieldErrors field_errors(const DistanceField& field, double extent) {
  constexpr int points = 500;
  const double h = 1e-6 * extent;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-extent, extent);
  const auto point = [&] { return Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random)); };
  FieldErrors worst;
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3d p = point(), q = p + 0.1 * point();
    const auto [distance, normal] = field(p);
    Eigen::Vector3d gradient;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(c);
      gradient[c] = (field(p + step).distance - field(p - step).distance) / (2 * h);
    }
    worst.growth = std::max(worst.growth, std::abs(distance - field(q).distance) / (p - q).norm() - 1);
    worst.length = std::max(worst.length, std::abs(normal.norm() - 1));
    worst.gradient = std::max(worst.gradient, (gradient - normal).norm());
    worst.surface = std::max(worst.surface, std::abs(field(p - distance * normal).distance));
  }
  return worst;
}

void expect_distance_field(const DistanceField& field, double extent) {
  const FieldErrors errors = field_errors(field, extent);
  EXPECT_LE(errors.growth, 1e-14);
  EXPECT_LE(errors.length, 1e-15);
  EXPECT_LE(errors.gradient, 1e-7);
  EXPECT_LE(errors.surface, 1e-14);
}

}  // namespace drape::verify
