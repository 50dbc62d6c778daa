#pragma once

#include <cmath>
#include <limits>
#include <span>

namespace drape::base {

/// The larger of two numbers, and NaN if one of them is: std::max(a, NaN) is a, so an error that is not a number would look
/// small.
inline double larger(double a, double b) { return a < b || std::isnan(b) ? b : a; }

/// The largest of some numbers, NaN if one of them is; minus infinity if there are none.
inline double largest(std::span<const double> numbers) {
  double result = -std::numeric_limits<double>::infinity();
  for (const double number : numbers) result = larger(result, number);
  return result;
}

}  // namespace drape::base
