#include "verify/support/convergence.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace drape::verify {

testing::AssertionResult has_order(const Convergence& c, double order, double tolerance) {
  const auto n = static_cast<Eigen::Index>(c.steps.size());
  if (n < 4 || c.errors.size() != c.steps.size()) return testing::AssertionFailure() << "fewer than three refinements";
  const Eigen::ArrayXd h = Eigen::ArrayXd::Map(c.steps.data(), n).log(), e = Eigen::ArrayXd::Map(c.errors.data(), n).log();
  const Eigen::ArrayXd between = (e.tail(n - 1) - e.head(n - 1)) / (h.tail(n - 1) - h.head(n - 1));
  const Eigen::ArrayXd from_mean = h - h.mean();
  const double slope = (from_mean * e).sum() / from_mean.square().sum();
  // A NaN is within nothing.
  const bool equal = ((between - order).abs() <= tolerance).all() && std::abs(slope - order) <= tolerance;
  return testing::AssertionResult(equal) << "measured orders " << between.transpose() << ", slope " << slope << ", declared "
                                         << order << "; the finest error is " << c.errors.back();
}

}  // namespace drape::verify
