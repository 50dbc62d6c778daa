#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace drape::results {

/// What one way to solve a problem cost and how far off it was.
struct Measured {
  double error = 0;           ///< NaN if it failed
  std::vector<double> times;  ///< of its repetitions [ms]; empty if it failed
};

/// The quartiles of repeated times [ms].
struct Quartiles {
  double lower, median, upper;
};

/// Throws std::invalid_argument if there are no times.
Quartiles quartiles(const std::vector<double>& times);

/// Whether the difference of two medians is no more than noise: the middle halves of their times overlap.
bool tied(const Measured& a, const Measured& b);

/// Between these lies the ratio of the median times of a and b with a probability of 95 %, by resampling both (bootstrap,
/// seeded)  [Efron 1979]. Both have times.
struct Interval {
  double lower, upper;
};
Interval ratio_of_medians(const Measured& a, const Measured& b);

/// The one with the least median time among those with an error of at most `error`; nothing is interpolated.
std::optional<std::size_t> quickest(std::span<const Measured> candidates, double error);

/// Those that are the quickest with an error of at most one of the `errors`, or would be with a time `slack` times shorter; in
/// the order given.
std::vector<std::size_t> near_quickest(std::span<const Measured> candidates, std::span<const double> errors, double slack);

}  // namespace drape::results
