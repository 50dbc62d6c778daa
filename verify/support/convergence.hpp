#pragma once

#include <gtest/gtest.h>

#include <vector>

namespace drape::verify {

/// Errors of the same run with several steps [s], from the coarsest to the finest.
struct Convergence {
  std::vector<double> steps;
  std::vector<double> errors;
};

/// Whether the measured order *equals* `order`, to both sides: between all neighbours, and as the slope of log error against
/// log step by least squares. At least three refinements.
testing::AssertionResult has_order(const Convergence& c, double order, double tolerance = 0.1);

}  // namespace drape::verify
