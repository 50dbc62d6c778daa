// Rest lengths of the parts of a divided edge.

#include "model/adaptive/rest_lengths.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace drape::verify::rest_lengths_test {
namespace {

using Eigen::Vector3d;
using model::split_rest_length;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST(RestLengths, AddUpExactlyAndAreInProportion) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  std::uniform_int_distribution<int> points(0, 9);
  for (int k = 0; k < 100000; ++k) {
    std::vector<Vector3d> chain(2 + points(random));
    for (Vector3d& point : chain) point = Vector3d(any(random), any(random), any(random));
    const double rest = std::exp2(10 * any(random));
    const std::vector<double> parts = split_rest_length(rest, chain);
    ASSERT_EQ(parts.size(), chain.size() - 1);
    double sum = 0, whole = 0;
    for (const double part : parts) sum += part;
    EXPECT_EQ(sum, rest);
    for (std::size_t j = 0; j < parts.size(); ++j) whole += (chain[j + 1] - chain[j]).norm();
    for (std::size_t j = 0; j < parts.size(); ++j)
      EXPECT_NEAR(parts[j], rest * (chain[j + 1] - chain[j]).norm() / whole, 12 * epsilon * rest);
  }
}

TEST(RestLengths, StretchAllPartsByTheSame) {
  const Vector3d from(0.1, -0.2, 0.3), to(1.1, 0.7, -0.4);
  const double rest = 1.3, stretch = (to - from).norm() / rest;
  const std::vector<Vector3d> chain{from, from + 0.17 * (to - from), from + 0.6 * (to - from), to};
  const std::vector<double> parts = split_rest_length(rest, chain);
  for (std::size_t j = 0; j < parts.size(); ++j)
    EXPECT_NEAR((chain[j + 1] - chain[j]).norm() / parts[j], stretch, 16 * epsilon) << "points on a line change no force";
}

TEST(RestLengths, AreNotThereWithoutALength) {
  EXPECT_THROW(split_rest_length(1, std::vector<Vector3d>(3, Vector3d::Zero())), std::invalid_argument);
}

}  // namespace
}  // namespace drape::verify::rest_lengths_test
